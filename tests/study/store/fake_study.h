#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "study/store/write/store.h"
#include "tests/support/temp_folder.h"

/// A small study whose every number is known from its seeds, for tests of store and export.
namespace passung::fake {

using test::TempFolder;

/// Texts with everything that CSV and JSON find hard.
inline constexpr const char* kHardText = "it's \"hard\",\nreally; Größe 1/2 \\ end";

inline plan::StudyPlan makePlan(int participants = 4) {
    plan::StudyPlan plan;
    plan.name = "fake";
    plan.version = "1.0";
    plan.title = "A fake study";
    plan.seed = 7;
    plan.participants = participants;
    plan.factors = {{"method", plan::FactorKind::Within, "", {{"penalty"}, {"god"}}},
                    {"clearance", plan::FactorKind::Within, "mm", {{"0.1"}, {"0,5"}}}};
    const std::vector<std::pair<std::string, std::string>> names = {
        {"penalty", "0.1"}, {"penalty", "0,5"}, {"god", "0.1"}, {"god", "0,5"}};
    for (const auto& [method, clearance] : names) {
        plan::Condition condition;
        condition.name = method + "/" + clearance;
        condition.levels_json = R"({"method": ")" + method + R"(", "clearance": ")" + clearance + R"("})";
        condition.params_json = "{}";
        plan.conditions.push_back(condition);
    }
    plan.blocks = {{"main", plan::Phase::Main, 1, plan::BlockOrder::Williams, 0}};
    plan.measures = {"completion_time_s", "peak_force_N"};
    plan.source_text = "# a fake protocol\nname = \"fake\"\n";
    plan.expanded_json = "{}";
    return plan;
}

/// `count` consecutive ticks; every field set, the durations too; of a scene without navigation.
inline std::vector<TickRecord> makeRecords(std::uint64_t seed, std::size_t count, std::int64_t first_tick = 0) {
    Random random(seed);
    const auto fill = [&random](auto& values) {
        for (auto& value : values) value = static_cast<std::remove_reference_t<decltype(value)>>(random.normal());
    };
    std::vector<TickRecord> records(count);
    for (std::size_t i = 0; i < count; ++i) {
        TickRecord& r = records[i];
        r.tick = first_tick + static_cast<std::int64_t>(i);
        fill(r.device_position_m);
        fill(r.device_quaternion);
        r.input_flags = static_cast<std::uint32_t>(random.next());
        r.periods = i % 16 == 15 ? 3 : 1;
        fill(r.hand_position_m);
        fill(r.hand_quaternion);
        fill(r.proxy_position_m);
        fill(r.proxy_quaternion);
        fill(r.force_N);
        fill(r.torque_Nm);
        r.hand_depth_m = static_cast<float>(random.uniform());
        r.proxy_depth_m = static_cast<float>(random.uniform());
        r.quality = static_cast<float>(random.uniform());
        r.status = static_cast<std::uint32_t>(random.next());
        r.contacts = static_cast<std::uint32_t>(random.next());
        r.iterations = static_cast<std::uint32_t>(random.next());
        r.nodes_visited = static_cast<std::uint32_t>(random.next());
        r.energy_J = static_cast<float>(random.normal());
        r.hand_energy_J = static_cast<float>(random.normal());
        r.proxy_gap_m = static_cast<float>(random.uniform());
        r.duration_ns = 987'650'000 + static_cast<std::int64_t>(random.below(10'000));
        r.processor_ns = 876'540'000 + static_cast<std::int64_t>(random.below(10'000));
    }
    return records;
}

/// The same of a scene whose parts are picked up.
inline std::vector<TickRecord> withBodies(std::uint64_t seed, std::vector<TickRecord> records) {
    Random random(seed);
    for (TickRecord& r : records) {
        r.held = static_cast<std::int32_t>(random.below(5)) - 1;
        r.steps_done = random.next() >> 1;
    }
    return records;
}

/// The same of a scene that asks what its effects add.
inline std::vector<TickRecord> withEffects(std::uint64_t seed, std::vector<TickRecord> records) {
    Random random(seed);
    for (TickRecord& r : records) {
        r.effects = 1u + static_cast<std::uint32_t>(random.below(127));
        r.guided = static_cast<float>(random.uniform());
        for (auto& wrench : r.effect_wrench)
            for (float& value : wrench) value = static_cast<float>(random.normal());
    }
    return records;
}

/// The same of a scene with navigation.
inline std::vector<TickRecord> withNavigation(std::uint64_t seed, std::vector<TickRecord> records) {
    Random random(seed);
    for (TickRecord& r : records) {
        r.navigation_clutched = static_cast<std::uint32_t>(random.below(2));
        r.navigation_scale = static_cast<float>(random.uniform());
        for (float& value : r.navigation_offset_m) value = static_cast<float>(random.normal());
        for (float& value : r.navigation_quaternion) value = static_cast<float>(random.normal());
    }
    return records;
}

/// Equal in every bit that is stored, so that NaN and -0 count too.
inline bool sameStoredBits(const TickRecord& a, const TickRecord& b) {
    const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    return a.tick == b.tick && same(a.device_position_m, b.device_position_m) &&
           same(a.device_quaternion, b.device_quaternion) && a.input_flags == b.input_flags && a.periods == b.periods &&
           same(a.hand_position_m, b.hand_position_m) && same(a.hand_quaternion, b.hand_quaternion) &&
           same(a.proxy_position_m, b.proxy_position_m) && same(a.proxy_quaternion, b.proxy_quaternion) &&
           same(a.force_N, b.force_N) && same(a.torque_Nm, b.torque_Nm) && same(a.hand_depth_m, b.hand_depth_m) &&
           same(a.proxy_depth_m, b.proxy_depth_m) && same(a.quality, b.quality) && a.status == b.status &&
           a.contacts == b.contacts && a.iterations == b.iterations && a.nodes_visited == b.nodes_visited &&
           same(a.energy_J, b.energy_J) && same(a.hand_energy_J, b.hand_energy_J) &&
           same(a.proxy_gap_m, b.proxy_gap_m) && a.navigation_clutched == b.navigation_clutched &&
           same(a.navigation_scale, b.navigation_scale) && same(a.navigation_offset_m, b.navigation_offset_m) &&
           same(a.navigation_quaternion, b.navigation_quaternion) && a.held == b.held && a.steps_done == b.steps_done &&
           a.effects == b.effects && same(a.guided, b.guided) && same(a.effect_wrench, b.effect_wrench);
}

inline bool sameStoredBits(const std::vector<TickRecord>& a, const std::vector<TickRecord>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const TickRecord& x, const TickRecord& y) { return sameStoredBits(x, y); });
}

inline store::OpenOptions options() {
    store::OpenOptions result;
    result.app_version = "0.0-test";
    result.now_utc = "2001-02-03T04:05:06.000Z";
    return result;
}

/// Listed order: trial i has condition i modulo the number of conditions.
inline std::vector<design::PlannedTrial> makeTrials(const plan::StudyPlan& plan, std::int64_t count,
                                                    const std::string& phase = "main") {
    std::vector<design::PlannedTrial> trials;
    for (std::int64_t i = 0; i < count; ++i) {
        const auto n = plan.conditions.size();
        trials.push_back({i, 0, "main, \"first\"", i, phase, static_cast<std::size_t>(i) % n,
                          static_cast<int>(static_cast<std::size_t>(i) / n) + 1});
    }
    return trials;
}

/// Opens, enrols and begins a session; throws (fails the test) if something is refused.
struct Session {
    std::unique_ptr<store::Store> store;
    std::unique_ptr<store::SessionWriter> writer;
};

template <class T>
T require(Result<T> result) {
    if (!result) throw std::runtime_error(toString(result.errors().front()));
    return *std::move(result);
}

inline std::unique_ptr<store::Store> openStore(const std::string& path, const store::OpenOptions& with = options()) {
    auto opened = store::Store::open(path, with);
    if (!opened.store) throw std::runtime_error(toString(opened.errors.front()));
    return std::move(opened.store);
}

inline std::unique_ptr<store::SessionWriter> beginSession(store::Store& store, const std::string& participant,
                                                          std::int64_t trials, bool timing_measured = false,
                                                          const plan::StudyPlan& plan = makePlan(),
                                                          std::size_t hands = 1) {
    store::SessionStart start;
    start.hands = hands;
    start.protocol_sha256 = require(store.importProtocol(plan));
    require(store.enrol(participant, plan::ParticipantKind::Simulated, store::UtcClock::virtualEpoch().at(0)));
    require(store.assignSlot(start.protocol_sha256, participant));
    start.participant = participant;
    start.ordinal = require(store.nextOrdinal(participant));
    start.seed = plan.seed;
    start.session_id = store::sessionId(plan.name, participant, start.ordinal, start.seed);
    start.device.name = "sigma7";
    start.device.label = kHardText;
    start.timing_measured = timing_measured;
    return require(store.createSession(start, makeTrials(plan, trials)));
}

inline session::AttemptStart attemptStart(std::int64_t trial_index) {
    session::AttemptStart start;
    start.trial_index = trial_index;
    start.start_ns = trial_index * 10'000'000'000;
    start.params_json = R"({"stiffness_N_per_m": 800})";
    start.stages = {{"penalty", kHardText}};
    start.seed = 0xfedcba9876543210u + static_cast<std::uint64_t>(trial_index);
    return start;
}

inline session::AttemptEnd attemptEnd(std::int64_t trial_index, std::size_t ticks, bool timing_measured = false) {
    session::AttemptEnd end;
    end.end_ns = trial_index * 10'000'000'000 + static_cast<std::int64_t>(ticks) * kTickNanoseconds;
    end.outcome = measures::Outcome::Success;
    end.timing_measured = timing_measured;
    for (const measures::MeasureDefinition& definition : measures::definitions()) {
        end.measures.push_back({definition.name, std::nullopt});
        if (definition.name == "completion_time_s")
            end.measures.back().value = 1.0 + 0.1 * static_cast<double>(trial_index);
        if (definition.name == "peak_force_N") end.measures.back().value = 1.0 / 3.0;
    }
    end.health.loop = timing_measured ? "real-time normal" : "virtual";
    end.health.ticks = static_cast<std::int64_t>(ticks);
    end.health.mean_us = 4711.25;
    end.health.max_us = 4711.75;
    end.health.histogram = {1, 2, 3};
    end.health.state_hash = 0x0123456789abcdefu;
    if (timing_measured)
        end.health.presentation = session::Presentation{"proxy",  90 + trial_index, 20'000.5, 30'000.0, 41'000.0,
                                                        "played", "speakers",       21'333.0, 7};
    if (timing_measured && trial_index == 5)  // the last one was to be heard, without an output, and nothing was drawn
        end.health.presentation = session::Presentation{"device", 0, 0.0, 0.0, 0.0, "silent", "", 0.0, std::nullopt};
    end.overlaps = {{3, true, false, true, 1e-6, 2e-6}, {7, false, true, false, 0.0, 0.5e-6}};
    end.health.contact_energy = {{"plate", 1.0 / 3.0, -0.25}, {"", static_cast<double>(trial_index), 0.0}};
    return end;
}

/// One whole attempt of `ticks` ticks, handed over in pieces of 300. Seed of the records: the trial's index.
inline Result<Done> writeAttempt(store::SessionWriter& writer, std::int64_t trial_index, std::size_t ticks,
                                 bool timing_measured = false) {
    const auto id = writer.startAttempt(attemptStart(trial_index));
    if (!id) return id.errors();
    const std::vector<TickRecord> records = makeRecords(static_cast<std::uint64_t>(trial_index), ticks);
    for (std::size_t i = 0; i < records.size(); i += 300) {
        writer.appendRecords(*id, 0, std::span(records).subspan(i, std::min<std::size_t>(300, records.size() - i)));
    }
    writer.appendEvent({*id, trial_index * 10'000'000'000, "session", "started", "{}"});
    return writer.finishAttempt(*id, attemptEnd(trial_index, ticks, timing_measured));
}

/// Takes from a database what later revisions added, as a program before there were hashes left it.
inline void makeOlderThanHashes(const std::string& path) {
    store::Database(path, store::OpenMode::ReadWrite)
        .execute(
            "ALTER TABLE contact_energy DROP COLUMN hand; DROP TABLE exact_overlap; DROP TABLE assembly_step; ALTER "
            "TABLE timing DROP COLUMN "
            "processor_mean_us; ALTER TABLE timing DROP "
            "COLUMN "
            "processor_p99_us; ALTER TABLE timing DROP COLUMN processor_p999_us; ALTER TABLE timing DROP COLUMN "
            "processor_max_us; DROP TABLE session_hash; DROP TABLE later_change; DROP TABLE row_hash; ALTER TABLE "
            "stream "
            "DROP COLUMN numerics; DELETE FROM schema_revision WHERE revision>=15");
}

}  // namespace passung::fake
