#include <gtest/gtest.h>

#include "tests/study/session/scripted_session.h"

// An experimenter's commands: what each does in which state, and what it leaves in the data.

namespace passung::session {
namespace {

using Kind = CommandKind;

class SessionCommands : public SessionTest {
protected:
    void begin(std::size_t trials, bool waits = false) {
        planTrials(std::vector<Records>(trials, successScript()));
        for (int i = 0; i < 8; ++i) apparatus_.scripts.push_back(successScript());  // of repetitions
        session_.emplace(SessionSetup{plan::FrozenPlan(plan_), trials_, "P001", 7, false, 1, waits}, apparatus_, sink_,
                         SessionListener{});
    }
    Reply tell(Kind kind, const std::string& text = {}, std::optional<AttemptId> attempt = {}) {
        return session_->command({kind, text, attempt});
    }
    /// Until so many attempts have ended and no trial runs.
    void finishAttempts(std::size_t count) {
        while (sink_.ends.size() < count) session_->advance();
    }
    void enterTrial() {
        while (session_->state() != SessionState::InTrial) session_->advance();
        session_->advance();
    }
    std::vector<std::int64_t> trialsBegun() const {
        std::vector<std::int64_t> order;
        for (const AttemptStart& start : sink_.starts) order.push_back(start.trial_index * 10 + start.attempt_no);
        return order;
    }
    std::optional<Session> session_;
};

using Order = std::vector<std::int64_t>;  // trial · 10 + attempt

TEST_F(SessionCommands, WaitsForItsStart) {
    // Truth: invariant
    begin(1, true);
    EXPECT_EQ(session_->advance(), SessionState::Ready);
    EXPECT_EQ(tell(Kind::Pause).text, "the session has not begun");
    EXPECT_EQ(tell(Kind::Continue).text, "the session is not paused");
    EXPECT_TRUE(sink_.starts.empty());
    EXPECT_TRUE(tell(Kind::Start).accepted);
    EXPECT_EQ(tell(Kind::Start).text, "the session has begun already");
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(session_->state(), SessionState::Complete);
    EXPECT_EQ(tell(Kind::Note, "late").text, "the session is over");
}

TEST_F(SessionCommands, APauseComesAfterTheRunningTrialAndEndsByCommand) {
    // Truth: invariant
    begin(2);
    enterTrial();
    EXPECT_EQ(tell(Kind::Pause).text, "pauses after trial 1");
    EXPECT_FALSE(tell(Kind::Pause).accepted);
    finishAttempts(1);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(session_->advance(), SessionState::Paused);
    EXPECT_EQ(sink_.starts.size(), 1u);
    EXPECT_EQ(tell(Kind::Pause).text, "the session is paused already");
    EXPECT_EQ(tell(Kind::Continue).text, "goes on with trial 2");
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 11}));
    EXPECT_TRUE(session_->isWhole());
}

TEST_F(SessionCommands, APauseNowAbortsTheRunningAttemptWhichIsDoneAgain) {
    // Truth: invariant: no trial is lost, also not when a pause was asked for before.
    begin(2);
    enterTrial();
    EXPECT_TRUE(tell(Kind::Pause).after_trial);
    const Reply now = session_->command({.kind = Kind::Pause, .text = "no picture", .source = "window", .now = true});
    EXPECT_TRUE(now.accepted);
    EXPECT_FALSE(now.after_trial);
    EXPECT_EQ(session_->state(), SessionState::Paused);
    EXPECT_EQ(sink_.ends.at(0).outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends.at(0).invalid_reason, "paused: no picture");
    EXPECT_EQ(tell(Kind::Pause).why, WhyNot::PausedAlready);
    EXPECT_TRUE(tell(Kind::Continue).accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 2, 11}));
    EXPECT_TRUE(session_->isWhole());
}

TEST_F(SessionCommands, APauseNowBetweenTrialsCostsNone) {
    // Truth: invariant.
    begin(2);
    enterTrial();
    finishAttempts(1);
    session_->command({.kind = Kind::Pause, .now = true});
    EXPECT_EQ(session_->state(), SessionState::Paused);
    EXPECT_TRUE(tell(Kind::Continue).accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 11}));
}

TEST_F(SessionCommands, RepeatAbortsTheRunningAttemptAndBeginsItsTrialAnew) {
    // Truth: invariant: attempts are never deleted.
    begin(2);
    enterTrial();
    EXPECT_TRUE(tell(Kind::Repeat, "phone rang").accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 2, 11}));
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "repeated by the experimenter: phone rang");
    EXPECT_EQ(session_->state(), SessionState::Complete);
    EXPECT_TRUE(session_->isWhole());
}

TEST_F(SessionCommands, RepeatAfterATrialMakesItsAttemptNoLongerCount) {
    // Truth: invariant: of two attempts at a trial one counts.
    begin(2);
    EXPECT_EQ(tell(Kind::Repeat).text, "no trial has ended yet");
    finishAttempts(1);
    EXPECT_TRUE(tell(Kind::Repeat, "wrong grip").accepted);
    EXPECT_EQ(tell(Kind::Repeat).text, "trial 1 is to be repeated already");
    ASSERT_EQ(sink_.invalidated.size(), 1u);
    EXPECT_EQ(sink_.invalidated[0].first, AttemptId{1});
    EXPECT_EQ(sink_.invalidated[0].second, "repeated by the experimenter: wrong grip");
    EXPECT_FALSE(session_->isWhole());
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 2, 11}));
    EXPECT_TRUE(session_->isWhole());
}

TEST_F(SessionCommands, SkipLeavesATrialOutAndTheSessionIsNotWhole) {
    // Truth: invariant
    begin(3);
    enterTrial();
    EXPECT_EQ(tell(Kind::Skip).text, "trial 1 is left out");
    EXPECT_EQ(sink_.ends.at(0).invalid_reason, "skipped by the experimenter");
    EXPECT_TRUE(tell(Kind::Skip).accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 21}));
    EXPECT_EQ(session_->state(), SessionState::Complete);
    EXPECT_FALSE(session_->isWhole());
}

TEST_F(SessionCommands, BackGoesTrialByTrialAndKeepsTheRunningOneForLater) {
    // Truth: closed form: trials 1 and 2 are done, 3 runs; one back is 2, one more is 1.
    begin(3);
    EXPECT_EQ(tell(Kind::Back).text, "there is no earlier trial");
    finishAttempts(2);
    enterTrial();
    EXPECT_EQ(tell(Kind::Back).text, "trial 2 is next");
    EXPECT_EQ(tell(Kind::Back).text, "trial 1 is next");
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 11, 21, 2, 12, 22}));
    ASSERT_EQ(sink_.invalidated.size(), 2u);
    EXPECT_TRUE(session_->isWhole());
}

TEST_F(SessionCommands, InvalidateNeedsAReasonAndMeansTheRunningElseTheLastElseTheNamedAttempt) {
    // Truth: invariant
    begin(4);
    EXPECT_EQ(tell(Kind::Invalidate, "x").text, "no attempt has ended yet");
    finishAttempts(3);
    EXPECT_EQ(tell(Kind::Invalidate).text, "to invalidate an attempt needs a reason");
    EXPECT_EQ(tell(Kind::Invalidate, "x", AttemptId{99}).text,
              "attempt 99 is not the newest one of a trial of this session");
    EXPECT_TRUE(tell(Kind::Invalidate, "slipped", AttemptId{1}).accepted);
    EXPECT_TRUE(tell(Kind::Invalidate, "slipped too").accepted);
    EXPECT_EQ(tell(Kind::Invalidate, "again").text, "the attempt of trial 3 is not valid anyway");
    ASSERT_EQ(sink_.invalidated.size(), 2u);
    EXPECT_EQ(sink_.invalidated[0].first, AttemptId{1});
    EXPECT_EQ(sink_.invalidated[1].first, AttemptId{3});
    enterTrial();
    EXPECT_TRUE(tell(Kind::Invalidate, "sneezed").accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(sink_.ends.at(3).outcome, Outcome::Success) << "it ran to its end";
    EXPECT_EQ(sink_.ends[3].invalid_reason, "invalidated by the experimenter: sneezed");
    EXPECT_FALSE(sink_.ends[3].valid);
}

TEST_F(SessionCommands, TheEmergencyStopHaltsTheMotorsFirstAndPauses) {
    // Truth: invariant: nothing comes between the command and the halt, and nothing moves before the continuation.
    begin(2);
    enterTrial();
    const std::size_t before = log_.size();
    EXPECT_TRUE(tell(Kind::Stop, "smoke").accepted);
    EXPECT_EQ(log_.at(before), "halt");
    EXPECT_EQ(sink_.ends.at(0).invalid_reason, "emergency stop: smoke");
    for (int i = 0; i < 3; ++i) EXPECT_EQ(session_->advance(), SessionState::Paused);
    EXPECT_EQ(std::count(log_.begin(), log_.end(), "start"), 1);
    EXPECT_TRUE(session_->view().stopped);
    EXPECT_TRUE(tell(Kind::Continue).accepted);
    EXPECT_EQ(log_.back(), "rearm");
    EXPECT_FALSE(session_->view().stopped);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(trialsBegun(), (Order{1, 2, 11})) << "the trial is done again";
}

TEST_F(SessionCommands, AbortEndsTheSessionWithItsReason) {
    // Truth: invariant
    begin(2);
    enterTrial();
    EXPECT_TRUE(tell(Kind::Abort, "nausea").accepted);
    EXPECT_EQ(session_->state(), SessionState::Interrupted);
    EXPECT_EQ(sink_.ends.at(0).invalid_reason, "aborted by the experimenter: nausea");
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(SessionCommands, EveryCommandIsLoggedWithItsSourceAcceptedOrNot) {
    // Truth: closed form. Tick 20 of the first trial: 19 periods after its tick 0.
    begin(1);
    tell(Kind::Continue);
    enterTrial();
    tell(Kind::Note, "calm");
    ASSERT_EQ(sink_.events.size(), 2u);
    EXPECT_EQ(sink_.events[0].event, "command_continue");
    EXPECT_EQ(sink_.events[0].payload_json, R"({"accepted":false,"refusal":"the session is not paused"})");
    EXPECT_FALSE(sink_.events[0].attempt);
    EXPECT_EQ(sink_.events[1].event, "command_note");
    EXPECT_EQ(sink_.events[1].source, "experimenter");
    EXPECT_EQ(sink_.events[1].attempt, AttemptId{1});
    EXPECT_EQ(sink_.events[1].t_ns, 19 * kMs);
    EXPECT_EQ(sink_.events[1].payload_json, R"({"accepted":true,"text":"calm"})");
    EXPECT_EQ(sink_.notes, std::vector<std::string>{"experimenter: calm"});
}

}  // namespace
}  // namespace passung::session
