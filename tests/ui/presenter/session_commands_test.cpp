#include "tests/study/session/scripted_session.h"
#include "ui/presenter/run.h"

// What the experimenter's screen lets them command, beside the real session that it shows.

namespace passung::session {
namespace {

using Kind = CommandKind;

class ShownCommands : public SessionTest {
protected:
    void begin(std::size_t trials, bool waits = false) {
        planTrials(std::vector<Records>(trials, successScript()));
        for (int i = 0; i < 4; ++i) apparatus_.scripts.push_back(successScript());  // of repetitions
        const auto listener = [this](const SessionEvent& event) {
            run_.take(event);
            if (std::holds_alternative<SessionView>(event)) prepared_.push_back(run_.view());
        };
        session_.emplace(SessionSetup{plan::FrozenPlan(plan_), trials_, "P001", 7, false, 1, waits}, apparatus_, sink_,
                         listener);
        run_.open(plan_);
        run_.take(presenter::SessionBegun{"P001", trials_});
    }
    /// Shows the session as it stands; why the screen does not offer the command.
    WhyNot offered(Kind kind) {
        run_.take(session_->view());
        return run_.view().why(kind);
    }
    /// What the session says to it.
    WhyNot told(Kind kind) { return session_->command({.kind = kind, .text = "so"}).why; }
    void expectRefused(Kind kind, WhyNot why) {
        EXPECT_EQ(offered(kind), why) << commandName(kind);
        EXPECT_EQ(told(kind), why) << commandName(kind);
    }
    void expectObeyed(Kind kind) { expectRefused(kind, WhyNot::Possible); }
    void enterTrial() {
        while (session_->state() != SessionState::InTrial) session_->advance();
        session_->advance();
    }

    std::optional<Session> session_;
    presenter::Run run_;
    std::vector<presenter::RunView> prepared_;  // as the screen is while each attempt's scene is built
};

TEST_F(ShownCommands, ATrialThatIsRepeatedAlreadyIsNotOfferedForItAgain) {
    // Truth: invariant: the session's own refusal.
    begin(3);
    while (sink_.ends.size() < 2) session_->advance();
    expectObeyed(Kind::Repeat);
    expectRefused(Kind::Repeat, WhyNot::RepeatedAlready);
    EXPECT_EQ(run_.view().session.permission(Kind::Repeat).text, "trial 2 is to be repeated already");
}

TEST_F(ShownCommands, AnAttemptThatDoesNotCountAnywayIsNotOfferedForThat) {
    // Truth: invariant: the session's own refusal.
    begin(3);
    expectRefused(Kind::Invalidate, WhyNot::NothingEnded);
    while (sink_.ends.size() < 1) session_->advance();
    EXPECT_EQ(session_->view().permission(Kind::Invalidate).attempt, AttemptId{1});
    expectObeyed(Kind::Invalidate);
    expectRefused(Kind::Invalidate, WhyNot::CountsNot);
}

TEST_F(ShownCommands, APauseIsOfferedOnceAndContinueOnlyInIt) {
    // Truth: invariant.
    begin(2, true);
    expectRefused(Kind::Pause, WhyNot::NotBegun);
    expectObeyed(Kind::Start);
    expectRefused(Kind::Start, WhyNot::BegunAlready);
    enterTrial();
    expectObeyed(Kind::Pause);
    EXPECT_FALSE(run_.view().session.pauses_after);
    expectRefused(Kind::Pause, WhyNot::PausesAlready);
    EXPECT_TRUE(run_.view().session.pauses_after);
    expectRefused(Kind::Continue, WhyNot::NotPaused);
    while (session_->state() == SessionState::InTrial) session_->advance();
    expectRefused(Kind::Pause, WhyNot::PausedAlready);
    EXPECT_FALSE(run_.view().session.pauses_after);
    expectObeyed(Kind::Continue);
    expectObeyed(Kind::Abort);
    expectRefused(Kind::Stop, WhyNot::NoSession);
}

TEST_F(ShownCommands, WhileASceneIsBuiltTheCommandsOfItsTrialAreOffered) {
    // Truth: invariant: what is pressed meanwhile is answered when the trial runs.
    begin(1);
    session_->advance();
    ASSERT_EQ(prepared_.size(), 1u);
    EXPECT_TRUE(prepared_[0].is<presenter::state::Preparing>());
    for (std::size_t kind = 0; kind < std::size(kCommandNames); ++kind) {
        const Kind each = static_cast<Kind>(kind);
        EXPECT_EQ(prepared_[0].why(each), offered(each)) << kCommandNames[kind];
    }
    EXPECT_TRUE(prepared_[0].may(Kind::Repeat)) << "although nothing has ended yet";
}

TEST_F(ShownCommands, AClockThatTheExperimenterHoldsIsStartedAndStoppedOnce) {
    // Truth: invariant.
    for (auto& condition : plan_.conditions) condition.timed_by = plan::TimedBy::Experimenter;
    begin(1);
    expectRefused(Kind::Done, WhyNot::NoTrial);
    enterTrial();
    expectRefused(Kind::Done, WhyNot::ClockNotStarted);
    expectObeyed(Kind::Start);
    expectRefused(Kind::Start, WhyNot::BegunAlready);
    expectObeyed(Kind::Failed);
    expectRefused(Kind::Done, WhyNot::NoTrial);
}

}  // namespace
}  // namespace passung::session
