#include "study/store/rows/staircase_rows.h"

#include <gtest/gtest.h>

#include "study/store/schema/sqlite.h"
#include "tests/study/store/fake_study.h"

namespace passung::store {
namespace {

using fake::require;

session::AttemptStart startOf(std::int64_t trial) {
    session::AttemptStart start;
    start.trial_index = trial;
    start.params_json = "{}";
    start.staircase = session::StaircaseStep{"accuracy", trial == 1 ? "" : "coarse", 71.0, 80.0, 3};
    return start;
}

/// Three trials of a staircase: answered, a catch trial, cut off by a crash.
void runThree(const std::string& path) {
    const auto store = fake::openStore(path);
    const auto writer = fake::beginSession(*store, "S001", 4);
    for (std::int64_t trial = 0; trial < 3; ++trial) {
        const auto attempt = require(writer->startAttempt(startOf(trial)));
        if (trial == 2) return;
        session::AttemptEnd end;
        end.outcome = measures::Outcome::Success;
        end.staircase = session::StaircaseAnswer{true, trial == 0, 62.5, 0.25};
        require(writer->finishAttempt(attempt, end));
    }
}

TEST(StaircaseRows, HoldWhatWasPresentedFromTheStartAndTheAnswerFromTheEnd) {
    // Truth: invariant: what was written is read back, bit by bit.
    const fake::TempFolder folder;
    runThree(folder / "s.db");
    const StoreReader reader = require(StoreReader::open(folder / "s.db"));
    const auto steps = require(reader.staircaseSteps());
    ASSERT_EQ(steps.size(), 3u);
    for (const StaircaseStepRow& step : steps) {
        EXPECT_EQ(step.staircase, "accuracy");
        EXPECT_EQ(step.wanted_level, 71.0);
        EXPECT_EQ(step.level, 80.0);
    }
    EXPECT_EQ(steps[0].track, "coarse");
    EXPECT_EQ(steps[0].positive, true);
    EXPECT_TRUE(steps[0].reversal);
    EXPECT_EQ(steps[0].estimate, 62.5);
    EXPECT_EQ(steps[0].estimate_sd, 0.25);
    EXPECT_FALSE(steps[1].track) << "a catch trial";
    EXPECT_FALSE(steps[2].positive || steps[2].estimate) << "it never ended";
    for (const AttemptRow& attempt : require(reader.attempts())) {
        EXPECT_EQ(attempt.presented_condition, "god/0,5") << "the fourth, whatever was planned";
        EXPECT_EQ(attempt.condition, fake::makePlan().conditions[static_cast<std::size_t>(attempt.trial_index)].name);
    }
}

TEST(StaircaseRows, AnUnfinishedSessionKnowsWhatItsTracksWereTold) {
    // Truth: closed form: neither the catch trial nor the trial that was cut off told a track anything.
    const fake::TempFolder folder;
    runThree(folder / "s.db");
    const auto store = fake::openStore(folder / "s.db");
    const Unfinished session = require(store->unfinished(""));
    ASSERT_EQ(session.attempts.size(), 3u);
    ASSERT_TRUE(session.attempts[0].step);
    EXPECT_EQ(session.attempts[0].step->staircase, "accuracy");
    EXPECT_EQ(session.attempts[0].step->track, "coarse");
    EXPECT_EQ(session.attempts[0].step->level, 80.0);
    EXPECT_TRUE(session.attempts[0].step->positive);
    EXPECT_FALSE(session.attempts[1].step);
    EXPECT_FALSE(session.attempts[2].step);
}

TEST(StaircaseRows, AConditionThatTheProtocolDoesNotHaveIsRefused) {
    // Truth: invariant: the attempt is not begun either.
    const fake::TempFolder folder;
    const auto store = fake::openStore(folder / "s.db");
    const auto writer = fake::beginSession(*store, "S001", 1);
    auto start = startOf(0);
    start.staircase->condition = 99;
    const auto attempt = writer->startAttempt(start);
    ASSERT_FALSE(attempt);
    EXPECT_NE(attempt.errors()[0].message.find("accuracy"), std::string::npos);
    require(writer->finishSession(false, 0));
    const StoreReader reader = require(StoreReader::open(folder / "s.db"));
    EXPECT_TRUE(require(reader.attempts()).empty());
}

}  // namespace
}  // namespace passung::store
