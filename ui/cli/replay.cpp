#include <fmt/format.h>

#include <algorithm>

#include "core/replay/replayer.h"
#include "study/protocol/protocol_reader.h"
#include "study/store/identity.h"
#include "study/store/store_reader.h"
#include "ui/app/run_study.h"
#include "ui/cli/commands.h"
#include "ui/cli/console.h"

namespace passung::cli {

namespace {

/// Replays attempts of one database; parts and protocols are built once.
class Replays {
public:
    explicit Replays(const store::StoreReader& reader) : reader_(reader) {}

    /// Prints one line per attempt; true if every bit was the same.
    Result<bool> replay(const store::AttemptRow& attempt) {
        auto plan = planOf(attempt.protocol_sha256);
        if (!plan) return plan.errors();
        const auto& conditions = (*plan)->conditions;
        const auto condition = std::find_if(conditions.begin(), conditions.end(),
                                            [&](const auto& c) { return c.name == attempt.condition; });
        if (condition == conditions.end()) {
            return Error{
                .message = "the stored protocol has no such condition", .key = "condition", .value = attempt.condition};
        }
        auto scene = model::buildScene(condition->scene, parts_);
        if (!scene) return scene.errors();
        const auto records = reader_.records(attempt.attempt_id);
        if (!records) return records.errors();
        const replay::ReplayReport report = replay::replay(*scene, *records);
        return tell(attempt, report);
    }

private:
    bool tell(const store::AttemptRow& attempt, const replay::ReplayReport& report) const {
        const std::string name =
            fmt::format("attempt {} ({}, session {}, trial {}, {})", attempt.attempt_id, attempt.participant_id,
                        attempt.session_ordinal, attempt.trial_index + 1, attempt.condition);
        if (report.first_difference) {
            const auto& d = *report.first_difference;
            fmt::print("{}: DIFFERS at tick {} in {}: recorded {}, replayed {}\n", name, d.tick, d.column, d.recorded,
                       d.replayed);
            return false;
        }
        const std::string hash = store::hexText(report.state_hash);
        if (!attempt.state_hash.empty() && attempt.state_hash != hash) {
            fmt::print("{}: DIFFERS in the state hash: recorded {}, replayed {}\n", name, attempt.state_hash, hash);
            return false;
        }
        fmt::print("{}: {} ticks, every recorded bit the same, state hash {}\n", name, report.ticks, hash);
        return true;
    }

    Result<const protocol::StudyPlan*> planOf(const std::string& sha256) {
        if (const auto known = plans_.find(sha256); known != plans_.end()) return &known->second;
        const auto rows = reader_.protocols();
        if (!rows) return rows.errors();
        for (const auto& row : *rows) {
            if (row.sha256 != sha256) continue;
            auto plan = protocol::readProtocolText(row.source_text, reader_.path() + ":" + row.name,
                                                   app::knownDevices(), app::knownMeasures());
            if (!plan) return plan.errors();
            return &plans_.emplace(sha256, std::move(*plan)).first->second;
        }
        return Error{.message = "is not in the database", .key = "protocol", .value = sha256};
    }

    const store::StoreReader& reader_;
    model::PartCache parts_;
    std::map<std::string, protocol::StudyPlan> plans_;
};

}  // namespace

int replay(const ReplayOptions& options) {
    const auto reader = store::StoreReader::open(options.database);
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
    }
    Replays replays(*reader);
    std::size_t different = 0;
    for (const auto& attempt : attempts) {
        const auto same = replays.replay(attempt);
        if (!same) return fail(same.errors());
        different += *same ? 0 : 1;
    }
    if (attempts.size() > 1) fmt::print("{} attempts replayed, {} differ\n", attempts.size(), different);
    return different == 0 ? 0 : 1;
}

}  // namespace passung::cli
