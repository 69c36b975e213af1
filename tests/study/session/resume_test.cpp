#include "study/session/resume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/study/session/scripted_session.h"

namespace passung::session {
namespace {

using plan::Repeat;
using Order = std::vector<std::size_t>;

/// Two trials of practice, then four of the main block.
class ResumeTest : public testing::Test {
protected:
    ResumeTest() {
        plan_.blocks.push_back({.name = "practice", .phase = plan::Phase::Practice});
        plan_.blocks.push_back({.name = "main"});
        for (std::size_t i = 0; i < 6; ++i) {
            design::PlannedTrial trial;
            trial.trial_index = static_cast<std::int64_t>(i);
            trial.block_index = i < 2 ? 0 : 1;
            trial.phase = i < 2 ? "practice" : "main";
            trials_.push_back(trial);
        }
    }
    void had(std::size_t place, std::optional<Outcome> outcome, bool valid = true) {
        int number = 1;
        for (const StoredAttempt& attempt : attempts_) number += attempt.place == place ? 1 : 0;
        attempts_.push_back({AttemptId{static_cast<std::int64_t>(attempts_.size() + 1)}, place, number, outcome,
                             valid && outcome.has_value()});
    }
    Resumption resumed(bool crashed = true) const { return resumption(plan_, trials_, attempts_, crashed, {}, steps_); }
    static Order rest(Agenda agenda) {
        Order order;
        for (; !agenda.empty(); agenda.end(Then::Done)) order.push_back(agenda.next());
        return order;
    }

    plan::StudyPlan plan_;
    std::vector<design::PlannedTrial> trials_;
    std::vector<StoredAttempt> attempts_;
    std::vector<OrderStep> steps_;
};

TEST_F(ResumeTest, GoesOnWithTheTrialThatCrashed) {
    // Truth: closed form
    EXPECT_EQ(rest(resumed().agenda), (Order{0, 1, 2, 3, 4, 5}));
    for (std::size_t place = 0; place < 3; ++place) had(place, Outcome::Success);
    EXPECT_EQ(rest(resumed().agenda), (Order{3, 4, 5})) << "killed between two trials";
    had(3, std::nullopt);
    EXPECT_EQ(rest(resumed().agenda), (Order{3, 4, 5}));
    EXPECT_EQ(resumed().past[3].attempts, 1);
    EXPECT_EQ(resumed().past[3].judged, 0) << "a crash uses up none of the attempts that the protocol allows";
    EXPECT_EQ(resumed().past[2].counting, AttemptId{3});
}

TEST_F(ResumeTest, KnowsWhatWasFinishedAndWhenItWasBegun) {
    // Truth: closed form: an attempt takes 10 ns.
    for (std::size_t place = 0; place < 4; ++place) {
        had(place, Outcome::Success);
        attempts_.back().start_ns = static_cast<std::int64_t>(10 * place);
        attempts_.back().measures = {{"place", static_cast<double>(place)}};
    }
    const std::vector<StoredForm> forms = {{"start", 0}, {"after 2", 30}};
    const auto with = [&] { return resumption(plan_, trials_, attempts_, true, forms); };
    ASSERT_EQ(with().finished.size(), 4u);
    EXPECT_EQ(with().finished[3].trial.trial_index, 3);
    EXPECT_EQ(with().finished[3].measures[0].value, 3.0);
    EXPECT_EQ(with().finished[3].begun_ns, 30);
    EXPECT_EQ(with().forms.size(), 2u) << "the desk decides which of them count";
    plan_.resume.restart_block = true;
    EXPECT_EQ(with().finished.size(), 2u) << "practice alone";
}

TEST_F(ResumeTest, OfAnOlderProgramAnAbortedAttemptIsCutOffOnlyWhereSomebodyEndedTheSession) {
    // Truth: closed form: no step tells of it. One that aborted by itself was over in the uninterrupted session too.
    had(0, Outcome::Aborted, false);
    EXPECT_EQ(rest(resumed(true).agenda).front(), 1u);
    EXPECT_EQ(rest(resumed(false).agenda).front(), 0u);
}

TEST_F(ResumeTest, TrialsThatWaitForTheEndOfTheirBlockStillDo) {
    // Truth: closed form
    plan_.blocks[1].on_timeout = Repeat::AtBlockEnd;
    plan_.blocks[1].on_invalid = Repeat::Now;
    had(0, Outcome::Success);
    had(1, Outcome::Success);
    had(2, Outcome::Timeout, false);
    had(3, Outcome::Success, false);
    EXPECT_EQ(rest(resumed().agenda), (Order{3, 4, 5, 2}));
    had(3, Outcome::Success, false);
    had(3, Outcome::Success, false);
    EXPECT_EQ(rest(resumed().agenda), (Order{4, 5, 2})) << "three attempts are the most";
}

TEST_F(ResumeTest, TheProtocolMayWantPracticeOrTheBlockAnew) {
    // Truth: closed form
    for (std::size_t place = 0; place < 4; ++place) had(place, Outcome::Success);
    had(4, std::nullopt);
    plan_.resume.redo_practice = true;
    EXPECT_EQ(rest(resumed().agenda), (Order{0, 1, 4, 5}));
    EXPECT_EQ(resumed().change.discounted, (std::vector<AttemptId>{AttemptId{2}, AttemptId{1}}));
    plan_.resume = {.restart_block = true};
    EXPECT_EQ(rest(resumed().agenda), (Order{2, 3, 4, 5}));
    EXPECT_EQ(resumed().change.discounted, (std::vector<AttemptId>{AttemptId{4}, AttemptId{3}}));
    EXPECT_FALSE(resumed().past[2].counting);
}

TEST_F(ResumeTest, WhatTheStepsTellGoesBeforeTheProtocol) {
    // Truth: closed form: trial 0 was stopped and is done again, 1 is left out, 2 is gone back to.
    had(0, Outcome::Aborted, false);
    had(2, Outcome::Success, false);
    const auto by = Decider::Experimenter;
    steps_ = {{0, Then::RepeatNow, by, AttemptId{1}}, {1, Then::Done, by, {}}};
    steps_.push_back({2, Then::Done, Decider::Protocol, AttemptId{2}});
    steps_.push_back({2, Then::RepeatNow, by, {}});
    EXPECT_EQ(rest(resumed().agenda), (Order{2, 0, 3, 4, 5}));
    EXPECT_EQ(resumed().past[0].judged, 0);
    EXPECT_EQ(resumed().past[2].judged, 1);
    EXPECT_TRUE(resumed().change.steps.empty()) << "all is told already";
    EXPECT_TRUE(resumed().finished.empty());
}

TEST_F(ResumeTest, OfAnAttemptMadeInvalidWhenNoSessionRanTheProtocolDecides) {
    // Truth: closed form
    had(0, Outcome::Success, false);
    steps_ = {{0, Then::Done, Decider::Protocol, AttemptId{1}}};
    EXPECT_EQ(rest(resumed().agenda), (Order{1, 2, 3, 4, 5}));
    plan_.blocks[0].on_invalid = Repeat::AtBlockEnd;
    EXPECT_EQ(rest(resumed().agenda), (Order{1, 0, 2, 3, 4, 5}));
    steps_[0].decided_by = Decider::Experimenter;
    EXPECT_EQ(rest(resumed().agenda), (Order{1, 2, 3, 4, 5})) << "left out while it ran";
}

TEST_F(ResumeTest, WhereNothingIsLeftWhatTheSessionLacksIsOffered) {
    // Truth: closed form: of the main block 3 was left out and 4 does not count; 0, of practice, is let be.
    for (const std::size_t place : {0, 1, 2, 4}) had(place, Outcome::Success, place != 0 && place != 4);
    steps_ = {{3, Then::Done, Decider::Experimenter, {}}};
    for (const StoredAttempt& attempt : attempts_)
        steps_.push_back({static_cast<std::int64_t>(attempt.place), Then::Done, Decider::Protocol, attempt.id});
    EXPECT_EQ(rest(resumed().agenda), Order{5});
    had(5, Outcome::Success);
    EXPECT_EQ(rest(resumed().agenda), (Order{3, 4}));
    EXPECT_EQ(resumed().change.steps.size(), 3u) << "that 5 ended, and both offers";
}

TEST_F(ResumeTest, ASessionThatIsTooOldDoesNotGoOn) {
    // Truth: closed form
    EXPECT_FALSE(tooOld({.max_age = 7200.0}, 7200.0));
    EXPECT_EQ(tooOld({.max_age = 7200.0}, 9000.0), "was interrupted 2.5 h ago, and the protocol lets it go on for 2 h");
    EXPECT_TRUE(tooOld({.max_age = 7200.0}, std::nan("")) == std::nullopt);
}

/// A session of three trials of one block whose first attempt times out.
class RepeatTest : public SessionTest {
protected:
    std::vector<std::int64_t> trialsBegun(const std::vector<Records>& scripts) {
        for (auto& condition : plan_.conditions) condition.task.timeout = 2.0;
        planTrials({scripts[0], scripts[1], scripts[2]});
        for (std::size_t i = 3; i < scripts.size(); ++i) apparatus_.scripts.push_back(scripts[i]);
        EXPECT_TRUE(runSession());
        std::vector<std::int64_t> order;
        for (const AttemptStart& start : sink_.starts) order.push_back(start.trial_index * 10 + start.attempt_no);
        return order;
    }
    const Records failing_ = script(4000, 100, kNever);
};

TEST_F(RepeatTest, ATimeOutIsRepeatedAtOnceAndTheEarlierAttemptDoesNotCount) {
    // Truth: closed form
    plan_.blocks[0].on_timeout = Repeat::Now;
    EXPECT_EQ(trialsBegun({failing_, successScript(), successScript(), successScript()}),
              (std::vector<std::int64_t>{1, 2, 11, 21}));
    EXPECT_FALSE(sink_.ends[0].valid);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "timeout: the trial is repeated");
    EXPECT_TRUE(sink_.ends[1].valid);
}

TEST_F(RepeatTest, AtTheEndOfTheBlockAndNoMoreThanTheMaximum) {
    // Truth: closed form: two attempts are the most; the last one counts, time-out or not.
    plan_.blocks[0].on_timeout = Repeat::AtBlockEnd;
    plan_.blocks[0].max_attempts = 2;
    EXPECT_EQ(trialsBegun({failing_, successScript(), successScript(), failing_}),
              (std::vector<std::int64_t>{1, 11, 21, 2}));
    EXPECT_EQ(sink_.ends[3].outcome, Outcome::Timeout);
    EXPECT_TRUE(sink_.ends[3].valid);
}

TEST_F(RepeatTest, InvalidAttemptsAreRepeatedByTheirOwnRule) {
    // Truth: closed form: ticks are lost in the first attempt; a valid time-out stays.
    plan_.blocks[0].on_invalid = Repeat::Now;
    Records lost = successScript();
    lost.erase(lost.begin() + 500);
    EXPECT_EQ(trialsBegun({lost, successScript(), failing_, successScript()}),
              (std::vector<std::int64_t>{1, 2, 11, 21}));
    EXPECT_EQ(sink_.ends[2].outcome, Outcome::Timeout);
    EXPECT_EQ(sink_.complete, true);
}

}  // namespace
}  // namespace passung::session
