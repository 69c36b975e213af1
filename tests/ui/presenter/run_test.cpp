#include "ui/presenter/run.h"

#include <gtest/gtest.h>

#include "ui/presenter/participant.h"

namespace passung {
namespace {

using namespace presenter;
using session::AttemptEnded;
using session::CommandKind;
using session::SessionState;
using session::SessionView;

/// A run of four trials; conditions "a" and "b" in turn.
Run begun() {
    plan::StudyPlan plan;
    plan.name = "study";
    plan.conditions.resize(2);
    plan.conditions[0].name = "a";
    plan.conditions[1].name = "b";
    Run run;
    run.open(plan);
    SessionBegun news{"T001", {}};
    for (int i = 0; i < 4; ++i) {
        design::PlannedTrial trial;
        trial.trial_index = i;
        trial.condition = static_cast<std::size_t>(i % 2);
        trial.phase = "main";
        news.trials.push_back(trial);
    }
    run.take(news);
    return run;
}

SessionView shown(SessionState state, std::size_t next, std::vector<bool> over = {false, false, false, false}) {
    SessionView news;
    news.state = state;
    news.next = next;
    news.over = std::move(over);
    return news;
}

TickRecord tickOf(std::int64_t tick, bool engaged, float force = 0.0f) {
    TickRecord record;
    record.tick = tick;
    record.status = engaged ? kEngaged : 0u;
    record.force_N = {0.0f, 0.0f, force};
    record.hand_quaternion = record.proxy_quaternion = {1.0f, 0.0f, 0.0f, 0.0f};
    record.duration_ns = 20'000;
    return record;
}

void feed(Run& run, std::int64_t from, std::int64_t to, bool engaged, float force = 0.0f) {
    std::vector<TickRecord> records;
    for (std::int64_t tick = from; tick < to; ++tick) records.push_back(tickOf(tick, engaged, force));
    run.take(records);
}

TEST(Run, GoesFromPreparingOverTheStartPoseToRunningByWhatTheTicksSay) {
    // Truth: invariant. The go is the first tick that is engaged, and the trial's time counts from there.
    presenter::Run run = begun();
    run.take(AttemptPrepared{0, "a", nullptr});
    EXPECT_TRUE(run.view().is<state::Preparing>());
    run.take(shown(SessionState::InTrial, 0));
    EXPECT_TRUE(run.view().is<state::ToStart>());
    feed(run, 0, 200, false);
    EXPECT_TRUE(run.view().is<state::ToStart>());
    EXPECT_EQ(run.view().trial_s, 0.0);
    feed(run, 200, 1701, true);
    EXPECT_TRUE(run.view().is<state::Running>());
    EXPECT_NEAR(run.view().trial_s, 1.5, 1e-9);
    EXPECT_EQ(run.view().rows[0].state, RowState::Running);
    EXPECT_EQ(run.view().rows[1].state, RowState::Waiting);
    EXPECT_EQ(run.view().condition, "a");
}

TEST(Run, NoFigureOfTheTrialBeforeStandsOverTheNextOne) {
    // Truth: invariant: before its first tick nothing of a trial is known.
    presenter::Run run = begun();
    run.take(AttemptPrepared{0, "a", nullptr});
    TickRecord pressed;
    pressed.tick = 1;
    pressed.periods = 1;
    pressed.force_N = {0.0f, 0.0f, 2.0f};
    pressed.hand_depth_m = 0.001f;
    run.take(std::vector{pressed});
    EXPECT_EQ(run.view().force_N, 2.0);
    EXPECT_NEAR(run.view().depth_mm, 1.0, 1e-6);
    run.take(AttemptPrepared{1, "b", nullptr});
    EXPECT_EQ(run.view().force_N, 0.0);
    EXPECT_EQ(run.view().depth_mm, 0.0);
}

TEST(Run, TellsTheRowsApart) {
    // Truth: invariant. What an attempt ended with stays; a trial that is over without one was left out.
    presenter::Run run = begun();
    run.take(AttemptEnded{0, measures::Outcome::Success, true, "", 2.5});
    run.take(shown(SessionState::BetweenTrials, 3, {true, true, true, false}));
    run.take(AttemptEnded{2, measures::Outcome::Timeout, true, "", 30.0});
    EXPECT_EQ(run.view().rows[0].state, RowState::Success);
    EXPECT_EQ(run.view().rows[0].time_s, 2.5);
    EXPECT_EQ(run.view().rows[1].state, RowState::Skipped);
    EXPECT_EQ(run.view().rows[2].state, RowState::Timeout);
    EXPECT_EQ(run.view().rows[3].state, RowState::Next);
    EXPECT_EQ(run.view().finished, 3u);
    // Sent back, it is to come again.
    run.take(shown(SessionState::InTrial, 0, {false, true, true, false}));
    EXPECT_EQ(run.view().rows[0].state, RowState::Running);
    run.take(AttemptEnded{0, measures::Outcome::Aborted, false, "emergency stop", {}});
    EXPECT_EQ(run.view().rows[0].state, RowState::Aborted);
    EXPECT_EQ(run.view().rows[0].attempts, 2);
}

TEST(Run, ShowsWhatAnEarlierProcessMadeOfTheTrials) {
    // Truth: invariant. Of four trials: a success, a time-out, one that was left out, one that was cut off.
    presenter::Run run = begun();
    SessionBegun again{"T001", {}};
    for (int i = 0; i < 4; ++i) {
        again.trials.emplace_back();
        again.trials.back().trial_index = i;
    }
    again.earlier = {{0, 2, measures::Outcome::Success, true, "", 2.5, true},
                     {1, 1, measures::Outcome::Timeout, true, "", 30.0, true},
                     {3, 1, measures::Outcome::Aborted, false, "interrupted", {}, false}};
    run.take(again);
    run.take(shown(SessionState::BetweenTrials, 3, {true, true, true, false}));
    const auto& rows = run.view().rows;
    EXPECT_EQ(rows[0].state, RowState::Success);
    EXPECT_EQ(rows[0].attempts, 2);
    EXPECT_EQ(rows[0].time_s, 2.5);
    EXPECT_EQ(rows[1].state, RowState::Timeout);
    EXPECT_EQ(rows[2].state, RowState::Skipped);
    EXPECT_EQ(rows[3].state, RowState::Next);
    EXPECT_EQ(rows[3].remark, "interrupted");
    EXPECT_EQ(run.view().finished, 3u);
}

TEST(Run, ShowsTheSessionsOwnPermissionsAndWithoutOneNone) {
    // Truth: invariant: nothing is decided here (with a real session: session_commands_test).
    EXPECT_EQ(presenter::Run().view().why(CommandKind::Pause), Why::NoSession);
    presenter::Run run = begun();
    EXPECT_EQ(run.view().why(CommandKind::Abort), Why::NoSession) << "it has not said anything yet";
    SessionView view = shown(SessionState::InTrial, 0);
    view.pauses_after = true;
    view.commands[static_cast<std::size_t>(CommandKind::Pause)].why = Why::PausesAlready;
    run.take(view);
    EXPECT_TRUE(run.view().session.pauses_after);
    for (std::size_t kind = 0; kind < view.commands.size(); ++kind)
        EXPECT_EQ(run.view().why(static_cast<CommandKind>(kind)), view.commands[kind].why);
    run.take(RunOver{false, {}});
    EXPECT_TRUE(run.view().is<state::Incomplete>());
    EXPECT_EQ(run.view().why(CommandKind::Stop), Why::NoSession);
}

TEST(Run, AnEmergencyStopIsShownUntilTheSessionGoesOn) {
    // Truth: invariant.
    presenter::Run run = begun();
    run.take(shown(SessionState::InTrial, 0));
    SessionView stopped = shown(SessionState::Paused, 0);
    stopped.stopped = true;
    run.take(stopped);
    EXPECT_TRUE(run.view().is<state::Stopped>());
    run.take(shown(SessionState::InTrial, 0));
    run.take(shown(SessionState::Paused, 1));
    EXPECT_TRUE(run.view().is<state::Paused>());
}

TEST(Run, ATrialThatTheParticipantNoLongerSeesIsPausedAtOnceAndOnlyOnce) {
    // Truth: invariant.
    presenter::Run run = begun();
    run.take(shown(SessionState::InTrial, 0));
    const auto pause = run.setDisplay(Display::Lost);
    ASSERT_TRUE(pause);
    EXPECT_EQ(pause->kind, CommandKind::Pause);
    EXPECT_TRUE(pause->now);
    EXPECT_FALSE(run.setDisplay(Display::Closed)) << "it pauses already";
    EXPECT_FALSE(run.setDisplay(Display::Shown)) << "only the experimenter goes on";
    run.take(RunOver{true, {}});
    EXPECT_FALSE(run.setDisplay(Display::Closed)) << "nothing is left to pause";
}

TEST(Run, TellsHowMuchOfASceneIsBuiltUntilItsTrialBegins) {
    // Truth: invariant.
    presenter::Run run = begun();
    run.take(AttemptPrepared{0, "a", nullptr});
    EXPECT_FALSE(run.view().built());
    run.take(BuildProgress{0.5});
    EXPECT_EQ(run.view().built(), 0.5);
    run.take(shown(SessionState::InTrial, 0));
    EXPECT_FALSE(run.view().built());
}

TEST(Run, KeepsWhatItWasWarnedOfUntilAnotherRunOpens) {
    // Truth: invariant.
    presenter::Run run = begun();
    run.take(session::SessionEvent(session::Warned{"no log is kept"}));
    run.take(session::SessionEvent(session::Warned{"no backup copy was made"}));
    EXPECT_EQ(run.view().warnings, (std::vector<std::string>{"no log is kept", "no backup copy was made"}));
    run.open({});
    EXPECT_TRUE(run.view().warnings.empty());
}

TEST(Run, CountsTheLoopsMissedCyclesAndItsRate) {
    // Truth: closed form. 1000 ticks over 1250 periods are 800 Hz.
    presenter::Run run = begun();
    std::vector<TickRecord> records;
    for (int i = 0; i < 1000; ++i) {
        TickRecord record = tickOf(i, true);
        record.periods = i % 4 == 3 ? 2 : 1;
        record.duration_ns = i == 500 ? 90'000 : 20'000;
        records.push_back(record);
    }
    run.take(records);
    ASSERT_TRUE(run.view().loop && run.view().loop->isWhole());
    EXPECT_EQ(run.view().loop->missed, 250);
    EXPECT_NEAR(run.view().loop->rate_hz, 800.0, 1e-9);
    EXPECT_NEAR(run.view().loop->typical_us, 20.0, 1e-4);
    EXPECT_NEAR(run.view().loop->longest_us, 90.0, 1e-4);
}

TEST(Run, AwaitsThePictureOfAPreparedTrialOnly) {
    // Truth: invariant: a trial that is prepared begins with its first picture; nothing else waits for one.
    presenter::Run run = begun();
    EXPECT_FALSE(run.checkFirstPicture(false)) << "nothing is prepared";
    run.take(AttemptPrepared{0, "a", nullptr});
    EXPECT_TRUE(run.checkFirstPicture(false));
    EXPECT_FALSE(run.checkFirstPicture(false)) << "it waits already";
    run.take(shown(SessionState::Preparing, 0));
    EXPECT_TRUE(run.view().is<state::AwaitingPicture>()) << "what else the session tells leaves it so";
    EXPECT_TRUE(run.checkFirstPicture(true));
    EXPECT_TRUE(run.view().is<state::Preparing>());
    run.take(shown(SessionState::InTrial, 0));
    EXPECT_FALSE(run.checkFirstPicture(false)) << "it has begun";
    EXPECT_TRUE(run.view().is<state::ToStart>());
}

TEST(Run, AwaitsNoPictureWhileModelsAreBuilt) {
    // Truth: invariant: the share that is built is told on the line that else tells of the picture.
    presenter::Run run = begun();
    run.take(AttemptPrepared{0, "a", nullptr});
    EXPECT_TRUE(run.checkFirstPicture(false));
    run.take(BuildProgress{0.25});
    EXPECT_FALSE(run.checkFirstPicture(false));
    EXPECT_FALSE(run.checkFirstPicture(true));
    EXPECT_TRUE(run.view().is<state::Preparing>());
    EXPECT_EQ(run.view().built(), 0.25);
    run.take(shown(SessionState::Interrupted, 0));
    EXPECT_FALSE(run.view().built()) << "the session is over, its build with it";
}

TEST(Run, AsksOneThingAtATimeAndThroughAPause) {
    // Truth: invariant: a form and a page are never open together; a pause hides what is open and closes nothing.
    presenter::Run run = begun();
    run.take(shown(SessionState::BetweenTrials, 0));
    run.take(FormDue{std::make_shared<FormRequest>()});
    EXPECT_TRUE(run.view().form());
    run.take(PageDue{1, "Do it.", ""});
    EXPECT_FALSE(run.view().form());
    run.take(shown(SessionState::Paused, 0));
    EXPECT_TRUE(run.view().is<state::Paused>());
    ASSERT_NE(run.view().page(), nullptr);
    EXPECT_EQ(run.view().page()->text, "Do it.");
    run.take(AttemptPrepared{0, "a", nullptr});
    EXPECT_EQ(run.view().page(), nullptr);
}

TEST(ParticipantView, ShowsTheForceOnlyToWhoCannotFeelItAndOnlyInTheTrial) {
    // Truth: invariant.
    presenter::Run run = begun();
    auto scene = std::make_shared<DrawnScene>();
    scene->parts.resize(1);
    ShadedMesh peg;
    peg.low_mm = {-10.0f, -10.0f, 0.0f};
    peg.high_mm = {10.0f, 10.0f, 50.0f};
    scene->parts[0].mesh = std::make_shared<const ShadedMesh>(peg);
    run.take(AttemptPrepared{0, "a", scene});
    run.take(shown(SessionState::InTrial, 0));
    feed(run, 0, 10, false, 2.0f);
    EXPECT_EQ(participantView(run, false).screen, ParticipantScreen::ToStart);
    EXPECT_FALSE(participantView(run, false).arrow);
    feed(run, 10, 20, true, 2.0f);
    EXPECT_EQ(participantView(run, false).screen, ParticipantScreen::Task);
    EXPECT_TRUE(participantView(run, false).arrow);
    EXPECT_NEAR(participantView(run, false).arrow_way.z(), 2.0 * kArrowPerNewton, 1e-9);
    // It begins where it leaves the part, else the part would hide it.
    EXPECT_NEAR((participantView(run, false).arrow_from - Vec3(0, 0, 0.05)).norm(), 0.0, 1e-7);
    EXPECT_FALSE(participantView(run, true).arrow);
}

TEST(Trace, KeepsAPeakOfOneTickAndTheLastTenSeconds) {
    // Truth: closed form.
    Trace trace;
    for (int i = 0; i < 15000; ++i) trace.add(1e-3 * i, i == 12345 ? 7.0 : 1.0);
    const auto spans = trace.spans();
    ASSERT_EQ(spans.size(), static_cast<std::size_t>(Trace::kSeconds / Trace::kStretch));
    EXPECT_EQ(trace.peak(), 7.0);
    int high = 0;
    for (const auto& span : spans) high += span.high > 1.0f ? 1 : 0;
    EXPECT_EQ(high, 1);
    for (int i = 15000; i < 23000; ++i) trace.add(1e-3 * i, 1.0);
    EXPECT_EQ(trace.peak(), 1.0);
    trace.add(0.0, 3.0);
    EXPECT_EQ(trace.spans().size(), 1u);
}

}  // namespace
}  // namespace passung
