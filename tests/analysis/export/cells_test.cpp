#include "analysis/export/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "analysis/export/export.h"
#include "study/store/people/participant_records.h"
#include "tests/analysis/export/csv_reader.h"
#include "tests/study/store/fake_study.h"

namespace passung::exporter {
namespace {

using fake::require;

TEST(RestrictedMean, IsTheAreaUnderTheCurve) {
    // Truth: closed form, areas of steps by hand. Three done at 2, 4 and 6 s: their mean. One of two at 4 s, the other
    // cut off at 10 s: 4 + 6/2 = 7, the mean of min(time, 10). One done at 6 s after another was cut off at 3 s: all
    // who are left are done, 6. Nobody done: the horizon.
    EXPECT_NEAR(restrictedMean({{2, true}, {4, true}, {6, true}}, 10), 4.0, 1e-12);
    EXPECT_NEAR(restrictedMean({{10, false}, {4, true}}, 10), 7.0, 1e-12);
    EXPECT_NEAR(restrictedMean({{6, true}, {3, false}}, 10), 6.0, 1e-12);
    EXPECT_NEAR(restrictedMean({{3, false}}, 10), 10.0, 1e-12);
    EXPECT_NEAR(restrictedMean({{12, true}, {4, true}}, 10), 7.0, 1e-12) << "what comes after the horizon is not seen";
    // Six, one of them cut off at 3 s, three done at 2, 3 and 5 s: 2 + 5/6 + 2 * 4/6 + 5 * (4/6 * 2/3) = ...
    EXPECT_NEAR(restrictedMean({{2, true}, {3, true}, {3, false}, {5, true}, {10, false}, {10, false}}, 10),
                2.0 + 1.0 * 5.0 / 6.0 + 2.0 * (5.0 / 6.0 * 4.0 / 5.0) + 5.0 * (5.0 / 6.0 * 4.0 / 5.0 * 2.0 / 3.0),
                1e-12);
    EXPECT_TRUE(std::isnan(restrictedMean({}, 10)));
}

/// An insertion block with three conditions and a line block with two of its own; person P has time
/// 1 + P + c in the first, 20 times that in the second; the last condition of S002's insertions runs out of time.
class BlockedStudy : public testing::Test {
protected:
    static constexpr double kTimeout = 8.0;

    static plan::StudyPlan plan() {
        plan::StudyPlan plan = fake::makePlan();
        plan.factors = {{"method", plan::FactorKind::Within, "", {{"a"}, {"b"}, {"c"}}}};
        plan.conditions.clear();
        std::string conditions;
        const auto add = [&](const std::string& name, const std::string& label, const char* type, const char* timeout) {
            plan::Condition condition;
            condition.name = name;
            condition.levels_json = "{\"method\": \"" + label + "\"}";
            condition.params_json = "{}";
            plan.conditions.push_back(condition);
            conditions += (conditions.empty() ? "" : ", ") + ("{\"condition\": \"" + name) +
                          "\", \"params\": {\"task\": {\"type\": \"" + type + "\", \"timeout_s\": " + timeout + "}}}";
        };
        for (const char* label : {"a", "b", "c"}) add(label, label, "peg_in_hole", "8");
        for (const char* label : {"a", "b"}) add(std::string(label) + "@line", label, "contour_following", "500");
        plan.measures = {"completion_time_s", "time_s",           "finished",
                         "insertion_depth_m", "contour_progress", "rate_limited_ticks"};
        plan.expanded_json =
            "{\"conditions\": [" + conditions +
            R"(], "blocks": [{"name": "practice", "phase": "practice"}, {"name": "insert", "phase": "main"}, )"
            R"({"name": "line", "phase": "main"}], "analyses": [{"outcome": "time_s", "factors": ["method"], )"
            R"("test": "rm_anova", "block": "insert", "staircase": ""}, {"outcome": "completion_time_s", )"
            R"("factors": ["method"], "test": "rm_anova", "block": "insert", "staircase": ""}, )"
            R"({"outcome": "time_s", "factors": [], "test": "mean", "block": "insert", "staircase": ""}]})";
        return plan;
    }

    void SetUp() override {
        auto store = fake::openStore(folder_ / "s.db");
        const auto plan = BlockedStudy::plan();
        for (int person = 1; person <= 3; ++person) writePerson(*store, plan, person);
        store.reset();
        exportNow();
    }

    void exportNow() { require(exportAll(require(store::StoreReader::open(folder_ / "s.db")), folder_ / "out", {})); }

    static void writePerson(store::Store& store, const plan::StudyPlan& plan, int person) {
        std::vector<design::PlannedTrial> trials = {{0, 0, "practice", 0, "practice", 0, 1}};
        for (std::int64_t i = 0; i < 6; ++i)
            trials.push_back(
                {1 + i, 1, "insert", i, "main", static_cast<std::size_t>(i % 3), 1 + static_cast<int>(i / 3)});
        for (std::int64_t i = 0; i < 2; ++i)
            trials.push_back({7 + i, 2, "line", i, "main", 3 + static_cast<std::size_t>(i), 1});
        store::SessionStart start;
        start.protocol_sha256 = require(store.importProtocol(plan));
        start.participant = "S00" + std::to_string(person);
        require(
            store.enrol(start.participant, plan::ParticipantKind::Simulated, store::UtcClock::virtualEpoch().at(0)));
        require(store.assignSlot(start.protocol_sha256, start.participant));
        start.ordinal = require(store.nextOrdinal(start.participant));
        start.seed = plan.seed;
        start.session_id = store::sessionId(plan.name, start.participant, start.ordinal, start.seed);
        start.device.name = "sigma7";
        auto writer = require(store.createSession(start, trials));
        for (const design::PlannedTrial& trial : trials) writeAttempt(*writer, trial, person);
        require(writer->finishSession(true, 100'000'000'000));
    }

    static void writeAttempt(store::SessionWriter& writer, const design::PlannedTrial& trial, int person) {
        const auto id = require(writer.startAttempt(fake::attemptStart(trial.trial_index)));
        writer.appendEvent({id, trial.trial_index * 10'000'000'000 + 25'000'000, "session", "trial_started", "{}"});
        session::AttemptEnd end = fake::attemptEnd(trial.trial_index, 40);
        const bool late = person == 2 && trial.condition == 2;
        if (late) end.outcome = measures::Outcome::Timeout;
        const bool line = trial.block == "line";
        double time =
            late ? kTimeout : 1.0 + person + static_cast<double>(trial.condition % 3) + 0.5 * trial.repetition;
        if (line) time *= 20.0;
        for (auto& measure : end.measures) {
            if (measure.name == "completion_time_s") measure.value = late ? std::nullopt : std::optional(time - 0.25);
            if (measure.name == "time_s") measure.value = time;
            if (measure.name == "finished") measure.value = late ? 0.0 : 1.0;
            if (measure.name == "insertion_depth_m" && !line) measure.value = 0.02;
            if (measure.name == "contour_progress" && line) measure.value = 1.0;
            if (measure.name == "rate_limited_ticks") measure.value = 7.0;
        }
        require(writer.finishAttempt(id, end));
    }

    std::string textOf(const std::string& name) {
        std::ifstream stream(folder_ / ("out/" + name), std::ios::binary);
        EXPECT_TRUE(stream) << name;
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    fake::CsvFile csv(const std::string& name) { return fake::readCsv(textOf(name)); }
    bool has(const std::string& name) { return std::ifstream(folder_ / ("out/" + name)).good(); }

    fake::TempFolder folder_;
};

TEST_F(BlockedStudy, CellsAreThoseOfTrialsByPersonSessionBlockAndLevel) {
    // Truth: independent path: the rows of trials.csv with counted = 1, taken together by their names; restricted means
    // by the mean of min(time, time-out), which they are where only the time-out cuts off.
    const auto trials = csv("trials.csv");
    std::map<std::vector<std::string>, std::vector<double>> times, completions;
    for (std::size_t row = 0; row < trials.rows.size(); ++row) {
        if (trials.at(row, "counted") != "1") continue;
        const std::vector<std::string> key = {trials.at(row, "participant_id"), trials.at(row, "session"),
                                              trials.at(row, "block"), trials.at(row, "method")};
        const double horizon = trials.at(row, "block") == "line" ? 500.0 : kTimeout;
        times[key].push_back(std::min(std::stod(trials.at(row, "time_s")), horizon));
        if (trials.at(row, "completion_time_s") != "NA")
            completions[key].push_back(std::stod(trials.at(row, "completion_time_s")));
    }
    const auto cells = csv("cells_long.csv");
    ASSERT_EQ(cells.rows.size(), times.size());
    ASSERT_EQ(cells.rows.size(), 3u * (3u + 2u)) << "no row for a condition that a block does not have";
    for (std::size_t row = 0; row < cells.rows.size(); ++row) {
        const std::vector<std::string> key = {cells.at(row, "participant_id"), cells.at(row, "session"),
                                              cells.at(row, "block"), cells.at(row, "method")};
        ASSERT_TRUE(times.count(key));
        EXPECT_NEAR(std::stod(cells.at(row, "time_s.restricted_mean")), meanOf(times[key]), 1e-12);
        EXPECT_EQ(cells.at(row, "n_trials"), std::to_string(times[key].size()));
        EXPECT_EQ(cells.at(row, "restricted_to_s"), cells.at(row, "block") == "line" ? "500" : "8");
        if (completions.count(key)) {
            EXPECT_NEAR(std::stod(cells.at(row, "completion_time_s.mean")), meanOf(completions[key]), 1e-12);
        } else {
            EXPECT_EQ(cells.at(row, "completion_time_s.mean"), "NA");
        }
        EXPECT_EQ(cells.at(row, "insertion_depth_m.mean") == "NA", key[2] == "line");
        EXPECT_EQ(cells.at(row, "contour_progress.mean") == "NA", key[2] == "insert");
    }
}

TEST_F(BlockedStudy, WideTablesAreOfOneMeasureAndBlockAndHoldNoColumnThatWasNotToBeMet) {
    // Truth: closed form: what the fake study wrote.
    const auto insert = csv("wide_time_s_insert.csv"), line = csv("wide_time_s_line.csv");
    EXPECT_TRUE(insert.has("time_s.a") && insert.has("time_s.b") && insert.has("time_s.c"));
    EXPECT_TRUE(line.has("time_s.a") && line.has("time_s.b"));
    EXPECT_FALSE(line.has("time_s.c"));
    ASSERT_EQ(insert.rows.size(), 3u);
    EXPECT_NEAR(std::stod(insert.at(0, "time_s.a")), 1.0 + 1.0 + 0.75, 1e-12);
    EXPECT_EQ(insert.at(1, "time_s.c"), "8") << "every time-out of S002 is known to have taken so long";
    EXPECT_EQ(csv("wide_completion_time_s_insert.csv").at(1, "completion_time_s.c"), "NA");
    EXPECT_TRUE(has("wide_insertion_depth_m_insert.csv") && has("wide_contour_progress_line.csv"));
    for (const char* none : {"wide_insertion_depth_m_line.csv", "wide_contour_progress_insert.csv", "wide_time_s.csv",
                             "wide_rate_limited_ticks_insert.csv", "wide_time_s_practice.csv"})
        EXPECT_FALSE(has(none)) << none;
}

TEST_F(BlockedStudy, TickCountersAreInTheTimingTableOnly) {
    // Truth: closed form: what the fake study wrote.
    EXPECT_EQ(csv("timing.csv").at(3, "rate_limited_ticks"), "7");
    EXPECT_FALSE(csv("trials.csv").has("rate_limited_ticks"));
    EXPECT_FALSE(csv("cells_long.csv").has("rate_limited_ticks.mean"));
}

TEST_F(BlockedStudy, WhoIsExcludedIsInNoCell) {
    // Truth: invariant; the trials stay, and say why they do not count.
    {
        const auto store = fake::openStore(folder_ / "s.db");
        require(store::ParticipantRecords(*store, {"e", ""}).exclude("S001", "asleep"));
    }
    exportNow();
    for (const char* file : {"cells_long.csv", "wide_time_s_insert.csv", "wide_time_s_line.csv"}) {
        const auto table = csv(file);
        EXPECT_FALSE(table.rows.empty());
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            EXPECT_NE(table.at(row, "participant_id"), "S001") << file;
    }
    const auto trials = csv("trials.csv");
    for (std::size_t row = 0; row < trials.rows.size(); ++row) {
        if (trials.at(row, "participant_id") != "S001") continue;
        EXPECT_EQ(trials.at(row, "counted"), "0");
        EXPECT_EQ(trials.at(row, "not_counted_because"), "the participant is excluded");
    }
}

TEST_F(BlockedStudy, TrialsTellTheirPlaceAndWhetherTheyCount) {
    // Truth: closed form: nine attempts in order, the first one practice; the trial began 25 ms after the attempt.
    const auto trials = csv("trials.csv");
    ASSERT_EQ(trials.rows.size(), 27u);
    EXPECT_EQ(trials.at(0, "not_counted_because"), "practice");
    const std::vector<std::string> positions = {"1", "1", "2", "3", "4", "5", "6", "1", "2"};
    const std::vector<std::string> previous = {"NA", "NA", "a", "b", "c", "a", "b", "NA", "a@line"};
    for (std::size_t row = 0; row < 9; ++row) {
        EXPECT_EQ(trials.at(row, "order_position"), positions[row]);
        EXPECT_EQ(trials.at(row, "previous_condition"), previous[row]);
        EXPECT_EQ(trials.at(row, "counted"), row == 0 ? "0" : "1");
        EXPECT_EQ(trials.at(row, "start_tick"), "25");
        EXPECT_EQ(trials.at(row, "end_tick"), "40");
    }
    const auto people = csv("participants.csv");
    for (std::size_t row = 0; row < trials.rows.size(); ++row)
        EXPECT_EQ(trials.at(row, "order_sequence"), people.at(row / 9, "sequence_index"));
}

TEST_F(BlockedStudy, APlannedAnalysisSaysWhomItKeeps) {
    // Truth: closed form: S002 has no completion time in condition c, but a time.
    const auto analyses = csv("analyses.csv");
    ASSERT_EQ(analyses.rows.size(), 3u);
    EXPECT_EQ(analyses.at(0, "value_column"), "time_s.restricted_mean");
    EXPECT_EQ(analyses.at(0, "r_formula"), "time_s.restricted_mean ~ method + Error(participant_id / (method))");
    EXPECT_EQ(analyses.at(0, "n_participants"), "3");
    EXPECT_EQ(analyses.at(0, "n_complete"), "3");
    EXPECT_EQ(analyses.at(1, "n_complete"), "2");
    EXPECT_EQ(analyses.at(2, "factors"), "NA") << "there is none";
    EXPECT_EQ(analyses.at(0, "r_call"), "summary(aov(" + analyses.at(0, "r_formula") + ", data = data))");
    EXPECT_NE(textOf("README.md").find("analyses.csv"), std::string::npos);
}

TEST_F(BlockedStudy, ABlocksFileDoesNotDependOnWhoHasBeenThere) {
    // Truth: invariant: the plan has two main blocks though nobody came to the second.
    StudyData study = require(readStudy(require(store::StoreReader::open(folder_ / "s.db"))));
    ASSERT_EQ(study.protocols[0].main_blocks, (std::vector<std::string>{"insert", "line"}));
    EXPECT_EQ(cellsOf(study).size(), 15u);
    std::erase_if(study.planned, [](const auto& row) { return row.block == "insert" && row.condition == "b"; });
    EXPECT_EQ(cellsOf(study).size(), 15u) << "what was made was planned";
    std::erase_if(study.attempts, [](const auto& attempt) { return attempt.condition == "a@line"; });
    const auto cells = cellsOf(study);
    ASSERT_EQ(cells.size(), 15u) << "what was planned and not made is an empty cell";
    EXPECT_TRUE(cells[3].attempts.empty());
    EXPECT_TRUE(std::isnan(valueOf(cells[3], "time_s")));
}

TEST(CanHave, FollowsTypeTimingAndTask) {
    // Truth: closed form (trial_types.h, TrialContext::watched)
    store::ConditionRow condition;
    EXPECT_TRUE(canHave(condition, "insertion_depth_m")) << "no plan tells";
    condition.task_type = "contour_following";
    EXPECT_FALSE(canHave(condition, "insertion_depth_m"));
    EXPECT_TRUE(canHave(condition, "contour_progress"));
    EXPECT_TRUE(canHave(condition, "peak_force_N"));
    EXPECT_FALSE(canHave(condition, "secondary_hit_rate"));
    condition.stimulus = "audio";
    EXPECT_TRUE(canHave(condition, "secondary_hit_rate"));
    condition.timed_by = "experimenter";
    EXPECT_FALSE(canHave(condition, "peak_force_N")) << "real parts";
    for (const char* measure : {"time_s", "finished", "success", "trial_time_s", "secondary_hit_rate"})
        EXPECT_TRUE(canHave(condition, measure)) << measure;
}

}  // namespace
}  // namespace passung::exporter
