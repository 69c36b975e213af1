#include "ui/presenter/participant.h"

#include <gtest/gtest.h>

namespace passung {
namespace {

using namespace presenter;
using session::AttemptEnded;
using session::CommandKind;
using session::SessionState;
using session::SessionView;
using Kind = TrialBrief::Kind;

SessionView shown(SessionState state) {
    SessionView told;
    told.state = state;
    told.next = 0;
    told.over = {false, false};
    return told;
}

class Participant : public testing::Test {
protected:
    Participant() {
        plan::StudyPlan plan;
        plan.conditions.resize(1);
        run_.open(plan);
    }
    void begin() {
        design::PlannedTrial trial;
        run_.take(SessionBegun{"P001", {trial, trial}});
    }
    void beginTrial(const TrialBrief& brief, bool hidden = false) {
        auto scene = std::make_shared<DrawnScene>();
        scene->hidden_in_trial = hidden;
        scene->parts.resize(1);
        scene->parts[0].mesh = std::make_shared<const ShadedMesh>();
        run_.take(AttemptPrepared{0, "a", scene, brief});
        run_.take(shown(SessionState::InTrial));
    }
    void tick(int count, bool engaged, std::uint32_t buttons = 0) {
        for (int i = 0; i < count; ++i) {
            TickRecord record;
            record.tick = tick_++;
            record.periods = 1;
            if (engaged) record.status = kEngaged;
            record.input_flags = buttons << 8;
            run_.take(std::span(&record, 1));
        }
    }
    ParticipantView view() const { return participantView(run_, true); }
    template <class State>
    bool is() const {
        return run_.view().is<State>();
    }

    presenter::Run run_;
    std::int64_t tick_ = 0;
};

TEST_F(Participant, SeesConsentPagesAndFormsOneAfterTheOther) {
    // Truth: invariant
    EXPECT_EQ(view().screen, ParticipantScreen::Welcome);
    auto clause = std::make_shared<FormRequest>();
    clause->consent = true;
    run_.take(session::viewBeforeSession());
    run_.take(FormDue{clause});
    EXPECT_TRUE(is<state::Consenting>());
    EXPECT_EQ(view().screen, ParticipantScreen::Form);
    EXPECT_EQ(run_.view().why(CommandKind::Pause), Why::NotBegun);
    EXPECT_TRUE(run_.view().may(CommandKind::Abort));
    run_.take(AskedDone{});
    EXPECT_TRUE(is<state::Opening>());
    begin();
    run_.take(shown(SessionState::Ready));
    EXPECT_EQ(view().screen, ParticipantScreen::Welcome);
    run_.take(shown(SessionState::BetweenTrials));
    run_.take(FormDue{std::make_shared<FormRequest>()});
    EXPECT_TRUE(is<state::Answering>());
    run_.take(shown(SessionState::Paused));
    EXPECT_EQ(view().screen, ParticipantScreen::Pause);
    run_.take(shown(SessionState::BetweenTrials));
    EXPECT_EQ(view().screen, ParticipantScreen::Form) << "it is still open";
    run_.take(AskedDone{});
    EXPECT_TRUE(is<state::Between>());
    run_.take(PageDue{1, "Do it.", ""});
    EXPECT_EQ(view().screen, ParticipantScreen::Page);
    beginTrial({});
    EXPECT_EQ(view().screen, ParticipantScreen::ToStart) << "nothing is asked in a trial";
}

TEST_F(Participant, IsLedThroughAPair) {
    // Truth: closed form, measures::PairWatch: engaged, not, engaged, not, button.
    begin();
    beginTrial({.kind = Kind::Pair, .question = "Which was stiffer?"});
    tick(5, false);
    EXPECT_EQ(view().screen, ParticipantScreen::ToStart);
    tick(5, true);
    EXPECT_EQ(view().screen, ParticipantScreen::Task);
    EXPECT_EQ(view().interval, 1);
    tick(5, false);
    EXPECT_EQ(view().screen, ParticipantScreen::ToStart);
    EXPECT_TRUE(view().start_mark);
    tick(5, true);
    EXPECT_EQ(view().screen, ParticipantScreen::Task);
    EXPECT_EQ(view().interval, 2);
    tick(5, false);
    EXPECT_EQ(view().screen, ParticipantScreen::Question);
    EXPECT_EQ(view().brief.question, "Which was stiffer?");
}

TEST_F(Participant, WaitsForTheExperimentersClockWithoutAScene) {
    // Truth: invariant.
    begin();
    beginTrial({.timed_by = plan::TimedBy::Experimenter});
    tick(50, true);
    EXPECT_EQ(view().screen, ParticipantScreen::ByHand);
    EXPECT_FALSE(view().scene);
    EXPECT_FALSE(view().begun);
    EXPECT_EQ(run_.view().trial_s, 0.0) << "ticks alone do not start that clock";
    run_.take(CommandAnswered{{.kind = CommandKind::Start}, {true, ""}});
    tick(50, true);
    EXPECT_TRUE(view().begun);
    EXPECT_NEAR(run_.view().trial_s, 0.05, 1e-9);
}

TEST_F(Participant, SeesNoSceneInATrialThatHidesItAndSeesItAgainAfterwards) {
    // Truth: the rule of feedback.scene: the start pose is shown, what comes after it is not; the next trial's is.
    begin();
    for (int round = 0; round < 3; ++round) {
        beginTrial({.kind = Kind::Pair, .question = "Which was stiffer?"}, true);
        tick(5, false);
        EXPECT_EQ(view().screen, ParticipantScreen::ToStart);
        EXPECT_TRUE(view().scene);
        tick(5, true);
        EXPECT_EQ(view().screen, ParticipantScreen::Task);
        EXPECT_FALSE(view().scene);
        tick(5, false);
        EXPECT_TRUE(view().scene) << "to the start of the second interval";
        tick(5, true);
        EXPECT_FALSE(view().scene);
        tick(5, false);
        EXPECT_EQ(view().screen, ParticipantScreen::Question);
        EXPECT_FALSE(view().scene);
        run_.take(AttemptEnded{0, measures::Outcome::Success, true, "", 3.4});
        beginTrial({});
        tick(5, true);
        EXPECT_TRUE(view().scene) << "another trial";
        run_.take(AttemptEnded{0, measures::Outcome::Success, true, "", 3.4});
    }
}

TEST_F(Participant, LearnsTheResultOnlyAsFarAsTheProtocolSays) {
    // Truth: closed form
    const auto resultOf = [this](plan::ShownResult result, measures::Outcome outcome) {
        beginTrial({.result = result});
        tick(5, true);
        EXPECT_FALSE(view().result) << "of the trial before";
        run_.take(AttemptEnded{0, outcome, true, "", 3.4});
        return view().result;
    };
    begin();
    EXPECT_FALSE(resultOf(plan::ShownResult::None, measures::Outcome::Success));
    const auto outcome = resultOf(plan::ShownResult::Outcome, measures::Outcome::Timeout);
    ASSERT_TRUE(outcome);
    EXPECT_FALSE(outcome->success);
    EXPECT_FALSE(outcome->time_s);
    const auto time = resultOf(plan::ShownResult::Time, measures::Outcome::Success);
    ASSERT_TRUE(time);
    EXPECT_TRUE(time->success);
    EXPECT_EQ(time->time_s, 3.4);
    EXPECT_FALSE(resultOf(plan::ShownResult::Time, measures::Outcome::Aborted)) << "not their doing";
}

TEST_F(Participant, SeesARestAndTheChangeOfADevice) {
    // Truth: invariant
    begin();
    SessionView resting = shown(SessionState::BetweenTrials);
    resting.rest = session::RestView{90, plan::RestEnds::ByParticipant};
    run_.take(resting);
    EXPECT_TRUE(is<state::Resting>());
    EXPECT_EQ(view().screen, ParticipantScreen::Rest);
    EXPECT_EQ(view().rest->seconds, 90);
    run_.take(shown(SessionState::BetweenTrials));
    EXPECT_EQ(view().screen, ParticipantScreen::Wait);
    SessionView swaps = shown(SessionState::Paused);
    swaps.awaited_device = "omega7";
    run_.take(swaps);
    EXPECT_EQ(view().screen, ParticipantScreen::Swap);
    run_.take(shown(SessionState::Paused));
    EXPECT_EQ(view().screen, ParticipantScreen::Pause);
}

}  // namespace
}  // namespace passung
