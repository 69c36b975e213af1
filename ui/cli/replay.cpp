#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "core/base/hex_text.h"
#include "core/replay/replayer.h"
#include "core/tick/numerics.h"
#include "study/run/files/builds.h"
#include "study/run/files/built_scenes.h"
#include "study/run/files/stored_plans.h"
#include "study/session/recompute.h"
#include "study/store/read/store_reader.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

enum class Verdict { Same, Differs, NotProven, NotComparable, Damaged };

/// Of an attempt that was cut off each hand's last ticks may be missing: what all have.
void trimToShortest(std::vector<std::vector<TickRecord>>& hands) {
    std::size_t least = hands.front().size();
    for (const auto& records : hands) least = std::min(least, records.size());
    for (auto& records : hands) records.resize(least);
}

/// Replays attempts of one database; parts and protocols are built once.
class Replays {
public:
    Replays(const store::StoreReader& reader, const ReplayArguments& options,
            const std::vector<store::DetectionRow>& detections, const std::vector<store::MeasureRow>& formulas)
        : reader_(reader),
          store_(run::openBuilds(options.import_limits)),
          plans_(reader, options.meshes, options.import_limits) {
        for (const auto& row : detections) detections_[row.attempt_id].push_back(row.detection);
        for (const auto& row : formulas) formula_versions_[row.measure] = row.formula_version;
    }

    /// Prints one line per attempt.
    Result<Verdict> replay(const store::AttemptRow& attempt) {
        if (attempt.numerics != tick::kNumerics) {
            fmt::print(
                "{}: not comparable: recorded by the arithmetic of numerics {}, this program computes by {}: passung "
                "{} "
                "made it\n",
                nameOf(attempt), attempt.numerics, tick::kNumerics, attempt.app_version);
            return Verdict::NotComparable;
        }
        auto plan = plans_.plan(attempt.protocol_sha256);
        if (!plan) return plan.errors();
        const auto& conditions = (*plan)->conditions;
        const auto condition = std::find_if(conditions.begin(), conditions.end(),
                                            [&](const auto& c) { return c.name == attempt.presented_condition; });
        if (condition == conditions.end()) {
            return Error{.message = "the stored protocol has no such condition",
                         .key = "condition",
                         .value = attempt.presented_condition};
        }
        std::vector<std::vector<TickRecord>> hands;
        for (std::size_t i = 0; i < condition->scene.handCount(); ++i) {
            auto records = reader_.records(attempt.attempt_id, i);
            if (!records) {
                fmt::print("{}: DAMAGED: {}\n", nameOf(attempt), records.errors().front().message);
                return Verdict::Damaged;
            }
            hands.push_back(*std::move(records));
        }
        if (!attempt.end_ns) trimToShortest(hands);
        if (hands.front().empty()) {
            fmt::print("{}: NOT PROVEN: no tick of it is recorded ({})\n", nameOf(attempt), attempt.outcome);
            return Verdict::NotProven;
        }
        std::size_t study_hands = 1;
        for (const plan::Condition& c : conditions) study_hands = std::max(study_hands, c.scene.handCount());
        const auto scenes = run::buildScenes(session::renderedScenes(*condition, attempt.seed), parts_);
        if (!scenes) return scenes.errors();
        const auto again = compareMeasures(attempt, *condition, hands, study_hands);
        if (!again) return again.errors();
        return tell(attempt, replay::replayHands(scenes->turns, hands), *again);
    }

private:
    static std::string nameOf(const store::AttemptRow& attempt) {
        return fmt::format("attempt {} ({}, session {}, trial {}, {})", attempt.attempt_id, attempt.participant_id,
                           attempt.session_ordinal, attempt.trial_index + 1, attempt.presented_condition);
    }

    /// What the recorded ticks give again of what was measured.
    struct MeasuresAgain {
        std::string difference;    // the first measure, or the outcome, that they do not give; empty if they give all
        std::string not_recorded;  // a measure that was not taken then, or by another formula: "x was not recorded"
    };

    /// Tells that the database holds the measure by another formula than this program's of a study with so many hands.
    std::optional<std::string> otherFormula(const std::string& measure, std::size_t study_hands) const {
        const auto recorded = formula_versions_.find(measure);
        const auto& all = measures::definitions();
        const auto own = std::ranges::find(all, measure, &measures::MeasureDefinition::name);
        if (recorded == formula_versions_.end() || own == all.end() ||
            recorded->second == measures::versionOf(*own, study_hands))
            return std::nullopt;
        return fmt::format("{} is by version {} of its formula", measure, recorded->second);
    }

    /// Bits count: the formulas are exact functions of what is stored.
    Result<MeasuresAgain> compareMeasures(const store::AttemptRow& attempt, const plan::Condition& condition,
                                          const std::vector<std::vector<TickRecord>>& hands,
                                          std::size_t study_hands) const {
        const auto outcome = measures::outcomeNamed(attempt.outcome);
        if (!outcome || !attempt.end_ns) return MeasuresAgain{};  // it did not end: nothing was measured
        session::StoredEnd end{*outcome, (*attempt.end_ns - attempt.start_ns) / kTickNanoseconds, {}, attempt.seed};
        auto overlaps = reader_.overlaps(attempt.attempt_id);
        if (!overlaps) return overlaps.errors();
        end.overlaps = *std::move(overlaps);
        if (attempt.trial_ns) end.start_time = (*attempt.trial_ns - attempt.start_ns) / kTickNanoseconds;
        const auto again = session::judgeAgain(condition, hands, end);
        if (!again) return again.errors();
        if (again->outcome != *outcome)
            return MeasuresAgain{fmt::format("outcome: stored {}, from the ticks {}", attempt.outcome,
                                             measures::outcomeName(again->outcome)),
                                 {}};
        const auto text = [](const std::optional<double>& value) {
            return value ? fmt::format("{}", *value) : std::string("none");
        };
        MeasuresAgain found_again;
        for (const measures::Value& value : again->measures) {
            if (const auto formula = otherFormula(value.name, study_hands)) {
                found_again.not_recorded = *formula;
                continue;
            }
            const auto found = attempt.measures.find(value.name);
            const auto& undefined = attempt.undefined_measures;
            if (found == attempt.measures.end() && std::ranges::find(undefined, value.name) == undefined.end()) {
                found_again.not_recorded = value.name + " was not recorded";
                continue;
            }
            const auto stored = found == attempt.measures.end() ? std::nullopt : std::optional(found->second);
            const bool same = stored && value.value
                                  ? std::bit_cast<std::uint64_t>(*stored) == std::bit_cast<std::uint64_t>(*value.value)
                                  : !stored && !value.value;
            if (!same) {
                found_again.difference =
                    fmt::format("{}: stored {}, from the ticks {}", value.name, text(stored), text(value.value));
                return found_again;
            }
        }
        if (const auto found = detections_.find(attempt.attempt_id);
            again->detections != (found == detections_.end() ? std::vector<measures::Detection>{} : found->second))
            found_again.difference = "the responses to the secondary task";
        return found_again;
    }

    static Verdict tell(const store::AttemptRow& attempt, const replay::ReplayReport& report,
                        const MeasuresAgain& again) {
        const std::string name = nameOf(attempt);
        if (report.first_difference) {
            const auto& d = *report.first_difference;
            fmt::print("{}: DIFFERS at tick {} in {}: recorded {}, replayed {}\n", name, d.tick, d.column, d.recorded,
                       d.replayed);
            return Verdict::Differs;
        }
        if (!again.difference.empty()) {
            fmt::print("{}: DIFFERS in {}\n", name, again.difference);
            return Verdict::Differs;
        }
        const auto& stored = attempt.contact_energy;  // none in older databases
        for (std::size_t i = 0; i < stored.size(); ++i) {
            if (stored.size() == report.pairs.size() && stored[i].taken_in_J == report.pairs[i].taken_in &&
                stored[i].least_J == report.pairs[i].least)
                continue;
            fmt::print("{}: DIFFERS in the energy of {}\n", name,
                       stored[i].obstacle.empty() ? "no obstacle" : stored[i].obstacle);
            return Verdict::Differs;
        }
        const std::string hash = hexText(report.state_hash);
        if (attempt.state_hash.empty()) {
            fmt::print(
                "{}: NOT PROVEN: {} ticks, every recorded bit the same, but there is no state hash to compare "
                "({})\n",
                name, report.ticks, attempt.outcome);
            return Verdict::NotProven;
        }
        if (attempt.state_hash != hash) {
            fmt::print("{}: DIFFERS in the state hash: recorded {}, replayed {}\n", name, attempt.state_hash, hash);
            return Verdict::Differs;
        }
        if (!again.not_recorded.empty()) {
            fmt::print("{}: NOT PROVEN: {} ticks, every recorded bit and every recorded measure the same, but {}\n",
                       name, report.ticks, again.not_recorded);
            return Verdict::NotProven;
        }
        fmt::print("{}: {} ticks, every recorded bit and every measure the same, state hash {}\n", name, report.ticks,
                   hash);
        return Verdict::Same;
    }

    const store::StoreReader& reader_;
    std::unique_ptr<run::Builds> store_;
    scene::PartCache parts_{store_.get()};
    run::StoredPlans plans_;
    std::map<std::int64_t, std::vector<measures::Detection>> detections_;  // by attempt
    std::map<std::string, std::int64_t> formula_versions_;                 // by measure, as recorded
};

}  // namespace

int replay(const ReplayArguments& options) {
    const auto reader = store::StoreReader::open(options.database, store::Damaged::HandedOut);
    if (!reader) return fail(reader.errors());
    std::vector<store::AttemptRow> attempts;
    if (options.attempt != 0) {
        auto attempt = reader->attempt(options.attempt);
        if (!attempt) return fail(attempt.errors());
        attempts.push_back(std::move(*attempt));
    } else {
        auto all = reader->attempts();
        if (!all) return fail(all.errors());
        attempts = std::move(*all);
        if (attempts.empty()) return fail({{.message = "holds no attempts", .file = options.database}});
    }
    const auto detections = reader->detections();
    if (!detections) return fail(detections.errors());
    const auto formulas = reader->measures();
    if (!formulas) return fail(formulas.errors());
    Replays replays(*reader, options, *detections, *formulas);
    std::map<Verdict, std::size_t> count;
    for (const auto& attempt : attempts) {
        const auto verdict = replays.replay(attempt);
        if (!verdict) return fail(verdict.errors());
        ++count[*verdict];
    }
    if (attempts.size() > 1) {
        const auto told = [&](Verdict verdict, const char* what) {
            return count[verdict] == 0 ? "" : fmt::format(", {} {}", count[verdict], what);
        };
        fmt::print("{} attempts replayed, {} differ{}{}{}\n",
                   attempts.size() - count[Verdict::NotComparable] - count[Verdict::Damaged], count[Verdict::Differs],
                   told(Verdict::NotProven, "could not be proven"), told(Verdict::NotComparable, "not comparable"),
                   told(Verdict::Damaged, "damaged and not compared"));
    }
    return count[Verdict::Same] == attempts.size() ? 0 : 1;
}

}  // namespace passung::cli
