#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "study/store/read/store_reader.h"
#include "study/store/schema/sqlite.h"
#include "tests/ui/cli/program.h"
#include "tests/ui/cli/small_study.h"

// A staircase whose answers are known: nobody inserts the peg in 0.4 s or less, everybody does in 20 s or more.

namespace passung::test {
namespace {

std::string study(const std::string& more = "catch_share = 0.2\ncatch_level = 30\n") {
    std::string text = smallStudy("stairs");
    const auto factor = text.find("[[factor]]");
    text.erase(factor, text.find("[task]") - factor);
    const auto block = text.find("order = \"williams\"");
    return text.substr(0, block) + R"(order = "random"

[[staircase]]
name = "time"
block = "main"
key = "task.timeout_s"
unit = "s"
levels = [0.1, 0.2, 0.4, 20, 30, 40]
logarithmic = true
rule = "1_up_1_down"
step_down = 1.2
max_trials = 6
skip_reversals = 1
tracks = [{ name = "above", start = 40 }, { name = "below", start = 0.1 }]
measure = "success"
above = 0.5
)" + more;
}

using Rows = std::vector<std::map<std::string, std::string>>;

Rows readCsv(const std::filesystem::path& path) {
    Rows rows;
    std::vector<std::string> names;
    for (const std::string& line : linesOf(readText(path))) {
        std::vector<std::string> cells;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
        if (names.empty()) {
            names = cells;
            continue;
        }
        rows.emplace_back();
        for (std::size_t i = 0; i < cells.size(); ++i) rows.back()[names.at(i)] = cells[i];
    }
    return rows;
}

/// Track and level of every trial whose answer counts, in time.
std::vector<std::pair<std::string, double>> answered(const std::string& database) {
    const auto reader = store::StoreReader::open(database);
    if (!reader) throw std::runtime_error(toString(reader.errors().front()));
    std::vector<std::pair<std::string, double>> steps;
    const auto all = reader->staircaseSteps();
    if (!all) throw std::runtime_error(toString(all.errors().front()));
    for (const auto& step : *all)
        if (step.positive) steps.emplace_back(step.track.value_or("catch"), step.level);
    return steps;
}

TEST(StaircaseRun, PresentsWhatTheRuleSaysAndFindsTheLevelWhereAnswersChange) {
    // Truth: closed form: one up, one down from what was presented, 1.2 decades, the nearest level; the change lies
    // between 0.4 and 20.
    const TempFolder folder;
    writeText(folder.path() / "study.toml", study());
    const auto checked = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_NE(checked.out.find("1 conditions, 15 trials"), std::string::npos) << checked.out;
    EXPECT_NE(checked.out.find("time  block main: task.timeout_s from 0.1 to 40 s, 6 levels"), std::string::npos);
    const auto run = runProgram(folder.path(), {"run", "study.toml", "--simulated", "2", "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto exported = runProgram(folder.path(), {"export", "s.db", "--out", "out", "--no-samples"});
    ASSERT_EQ(exported.exit_code, 0) << exported.err;

    const Rows rows = readCsv(folder.path() / "out/staircase.csv");
    EXPECT_LE(rows.size(), 30u) << "a track that has turned often enough ends before its 15 trials";
    EXPECT_GE(rows.size(), 20u);
    std::map<std::string, std::pair<double, bool>> last;  // of each participant's track: level, answer
    for (const auto& row : rows) {
        const double level = std::stod(row.at("level")), wanted = std::stod(row.at("wanted_level"));
        EXPECT_EQ(row.at("positive"), level > 1.0 ? "1" : "0");
        if (row.at("track") == "NA") {
            EXPECT_EQ(level, 30.0) << "a catch trial";
            continue;
        }
        const std::string track = row.at("participant_id") + row.at("track");
        if (const auto before = last.find(track); before != last.end()) {
            const double steps = before->second.second ? -1.2 : 1.2;
            EXPECT_NEAR(wanted, std::clamp(before->second.first * std::pow(10.0, steps), 0.1, 40.0), 1e-9);
        }
        last[track] = {level, row.at("positive") == "1"};
    }
    EXPECT_EQ(last.size(), 4u);
    const Rows thresholds = readCsv(folder.path() / "out/thresholds.csv");
    ASSERT_EQ(thresholds.size(), 4u);
    for (const auto& row : thresholds) {
        EXPECT_EQ(row.at("n_trials"), "6");
        EXPECT_GT(std::stod(row.at("estimate")), 0.4);
        EXPECT_LT(std::stod(row.at("estimate")), 20.0);
    }
    EXPECT_EQ(readCsv(folder.path() / "out/cells_long.csv").size(), 0u) << "levels that vary enter no mean";

    const auto replayed = runProgram(folder.path(), {"replay", "s.db"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
    EXPECT_NE(replayed.out.find(std::to_string(rows.size()) + " attempts replayed, 0 differ"), std::string::npos);
}

TEST(StaircaseRun, AnAnswerThatIsInvalidatedLaterIsInNoThreshold) {
    // Truth: invariant: without its last answer a track has the estimate that it had before that answer.
    const TempFolder folder;
    writeText(folder.path() / "study.toml", study());
    ASSERT_EQ(runProgram(folder.path(), {"run", "study.toml", "--db", "s.db"}).exit_code, 0);
    const auto tables = [&] {
        EXPECT_EQ(runProgram(folder.path(), {"export", "s.db", "--out", "out", "--no-samples"}).exit_code, 0);
        return std::pair(readCsv(folder.path() / "out/staircase.csv"), readCsv(folder.path() / "out/thresholds.csv"));
    };
    const auto [steps, whole] = tables();
    const std::string track = whole.front().at("track");
    std::vector<std::string> estimates, attempts;
    for (const auto& step : steps) {
        if (step.at("track") != track) continue;
        estimates.push_back(step.at("estimate"));
        attempts.push_back(std::to_string(std::stoi(step.at("trial_index")) + 1));
    }
    EXPECT_EQ(whole.front().at("estimate"), estimates.back());
    EXPECT_NE(estimates.back(), estimates.at(estimates.size() - 2)) << "the last answer tells nothing";
    const auto done = runProgram(folder.path(), {"session", "invalidate", "s.db", "--attempt", attempts.back(),
                                                 "--reason", "the participant sneezed"});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const auto [later, without] = tables();
    EXPECT_EQ(without.front().at("estimate"), estimates.at(estimates.size() - 2));
    EXPECT_EQ(without.front().at("n_trials"), "5");
    EXPECT_EQ(without.front().at("n_invalidated"), "1");
    EXPECT_EQ(without.back().at("n_invalidated"), "0");
    EXPECT_EQ(later.size(), steps.size()) << "what was recorded stays";
}

TEST(StaircaseRun, KilledAndResumedItPresentsWhatTheUninterruptedRunDoes) {
    // Truth: independent program (the uninterrupted run)
    const TempFolder whole, folder;
    for (const TempFolder* where : {&whole, &folder}) writeText(where->path() / "study.toml", study());
    ASSERT_EQ(runProgram(whole.path(), {"run", "study.toml", "--db", "s.db"}).exit_code, 0);
    std::vector<std::string> arguments{"run", "study.toml", "--db", "s.db", "--no-backup"};
    int kills = 0;
    for (bool ended = false; !ended && kills < 20; ++kills) {
        Program program(folder.path(), arguments, true);
        // Two trials are finished: it is killed while it begins or performs the third.
        for (int trial = 0; trial < 2 && !program.nextAcknowledgement().empty();) ++trial;
        program.killNow();
        const int code = program.wait();
        ended = code == 0 || program.err().find("no session that did not complete") != std::string::npos;
        arguments = {"resume", "s.db", "--no-backup"};
    }
    EXPECT_GE(kills, 5);
    EXPECT_EQ(answered(folder / "s.db"), answered(whole / "s.db"));
    const store::Database database(folder / "s.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT end_state FROM session"), "complete");
}

TEST(StaircaseRun, EndsWithItsReversals) {
    // Truth: closed form: answers alternate around the change, so that two reversals come long before 6 trials.
    const TempFolder folder;
    writeText(folder.path() / "study.toml", study("max_reversals = 2\n"));
    const auto run = runProgram(folder.path(), {"run", "study.toml", "--db", "s.db"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::size_t trials = answered(folder / "s.db").size();
    EXPECT_LT(trials, 12u);
    EXPECT_NE(run.out.find("S001 (1 of 1): " + std::to_string(trials) + " trials, "), std::string::npos) << run.out;
    const auto checked = runProgram(folder.path(), {"check", "study.toml"});
    EXPECT_NE(checked.out.find("at most 12 trials for each"), std::string::npos) << checked.out;
    const store::Database database(folder / "s.db", store::OpenMode::ReadOnly);
    EXPECT_EQ(database.text("SELECT end_state FROM session"), "complete") << "trials that are not needed do not lack";
}

}  // namespace
}  // namespace passung::test
