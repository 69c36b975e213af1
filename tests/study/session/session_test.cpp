#include "study/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/study/session/scripted_session.h"

namespace passung::session {
namespace {

TEST_F(SessionTest, SuccessIsDecidedAtTheTickWhereTheHoldEnds) {
    // Truth: closed form (see kSuccessTick)
    planTrials({successScript()});
    ASSERT_TRUE(runSession());
    ASSERT_EQ(sink_.ends.size(), 1u);
    const AttemptEnd& end = sink_.ends[0];
    EXPECT_EQ(end.outcome, Outcome::Success);
    EXPECT_TRUE(end.valid);
    EXPECT_EQ(end.invalid_reason, "");
    EXPECT_EQ(end.end_ns, kSuccessTick * kMs);
    EXPECT_FALSE(end.timing_measured);
    EXPECT_DOUBLE_EQ(value(end, "trial_time_s").value(), 1.45);
    EXPECT_DOUBLE_EQ(value(end, "approach_time_s").value(), 0.9);
    EXPECT_EQ(eventTimes(),
              (std::vector<std::string>{"trial_started@100", "first_contact@1000", "engaged@1000", "success@1550"}));
    EXPECT_EQ(trial_times_, std::vector<std::optional<double>>{1.45});
    EXPECT_EQ(sink_.complete, true);
}

TEST_F(SessionTest, CallsComeInTheOrderThatKeepsDataSafe) {
    // Truth: invariant: prepared before stored, stopped before finished, durable before acknowledged.
    planTrials({successScript(), successScript()});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(log_, (Log{"prepare soft", "startAttempt", "start", "appendRecords", "stop", "finishAttempt", "ended 1/2",
                         "prepare hard", "startAttempt", "start", "appendRecords", "stop", "finishAttempt", "ended 2/2",
                         "finishSession"}));
    EXPECT_EQ(apparatus_.most_ticks_at_once, Session::kTicksPerPoll);
}

TEST_F(SessionTest, RestsBeforeABlockAndSaysWhenTheDeviceIsSwapped) {
    // Truth: closed form: the second block asks for 2.05 s before its first trial, nothing before its second.
    planTrials({successScript(), successScript(), successScript()});
    plan_.blocks.resize(2);
    plan_.blocks[1].rest = 2.05;
    for (std::size_t i = 1; i < 3; ++i) {
        trials_[i].block_index = 1;
        trials_[i].block = "late";
        trials_[i].trial_in_block = static_cast<std::int64_t>(i) - 1;
    }
    plan_.conditions[0].device = "arm";
    plan_.conditions[1].device = "stick";
    ASSERT_TRUE(runSession());
    EXPECT_EQ(apparatus_.waited_ticks, 2050);
    EXPECT_EQ(apparatus_.most_ticks_at_once, Session::kTicksPerRest);
    std::vector<std::string> notes;
    for (const Event& event : sink_.events)
        if (!event.attempt) notes.push_back(event.event + " " + event.payload_json);
    EXPECT_EQ(notes, (std::vector<std::string>{R"(rest_started {"block":"late"})", R"(rest_ended {"block":"late"})",
                                               R"(swap_device {"to":"stick"})", R"(device_swapped {"to":"stick"})",
                                               R"(swap_device {"to":"arm"})", R"(device_swapped {"to":"arm"})"}));
    EXPECT_EQ(sink_.starts[1].start_ns, sink_.starts[0].start_ns + 1560 * kMs + 2050 * kMs);
}

TEST_F(SessionTest, WaitsForTheExperimenterWhenADeviceIsSwapped) {
    // Truth: invariant: nothing of the next trial happens before Continue; the event holds the stable stiffness in
    // force; a session without an experimenter goes on by itself (above).
    planTrials({successScript(), successScript()});
    plan_.conditions[0].device = "arm";
    plan_.conditions[1].device = "stick";
    plan_.stable_stiffness = {{"arm", 4000.0, 8.0, "model"}, {"stick", 1000.0, 0.0, "calibrated"}};
    SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, false};
    setup.waits = true;
    Session session(std::move(setup), apparatus_, sink_, {});
    ASSERT_TRUE(session.command({CommandKind::Start}).accepted);
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Paused);
    EXPECT_EQ(sink_.starts.size(), 1u);
    EXPECT_EQ(sink_.events.back().event, "swap_device");
    EXPECT_EQ(sink_.events.back().payload_json, R"({"to":"stick","stable_stiffness_N_per_m":1000,)"
                                                R"("stable_rotational_stiffness_Nm_per_rad":0,"origin":"calibrated"})");
    ASSERT_TRUE(session.command({CommandKind::Continue}).accepted);
    ASSERT_TRUE(session.run());
    EXPECT_EQ(session.state(), SessionState::Complete);
    EXPECT_EQ(sink_.starts.size(), 2u);
    const auto swapped = std::count_if(sink_.events.begin(), sink_.events.end(),
                                       [](const Event& event) { return event.event == "device_swapped"; });
    EXPECT_EQ(swapped, 1);
}

/// Answers 1 to the only item of every form, at the second look.
class Answering : public QuestionnaireSource {
public:
    std::optional<FilledForm> fill(const ShownQuestionnaire&) override {
        if (++looks_ % 2 == 1) return std::nullopt;
        return FilledForm{{{{1.0, ""}, {}, 0}}, "simulated"};
    }

private:
    int looks_ = 0;
};

TEST_F(SessionTest, QuestionnairesAreAskedWhenTheTrialBeforeIsDurableAndTheNextHasNotBegun) {
    // Truth: invariant: the list of calls. Nobody there to answer: the session fails before its first trial.
    for (const auto& [key, moment] : {std::pair{"start", plan::Moment::SessionStart},
                                      {"trial", plan::Moment::AfterTrial},
                                      {"end", plan::Moment::SessionEnd}}) {
        plan::PlannedQuestionnaire planned;
        planned.definition.key = key;
        planned.definition.items.resize(1);
        planned.definition.items[0].response.high = 1.0;
        planned.moment = moment;
        plan_.questionnaires.push_back(planned);
    }
    planTrials({successScript(), successScript()});
    Answering answers;
    {
        SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, false};
        setup.answers = &answers;
        Session session(setup, apparatus_, sink_, {});
        ASSERT_TRUE(session.run());
    }
    EXPECT_EQ(log_, (Log{"storeQuestionnaire start", "prepare soft", "startAttempt", "start", "appendRecords", "stop",
                         "finishAttempt", "storeQuestionnaire trial", "prepare hard", "startAttempt", "start",
                         "appendRecords", "stop", "finishAttempt", "storeQuestionnaire trial", "storeQuestionnaire end",
                         "finishSession"}));
    EXPECT_EQ(sink_.complete, true);
    Session alone({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, {});
    EXPECT_FALSE(alone.run());
    EXPECT_EQ(alone.errors().front().message, "nobody is there to answer it");
}

TEST_F(SessionTest, EveryTickThatTheLoopMadeIsStoredBeforeTheAttemptIsFinished) {
    // Truth: invariant. The decision falls in tick 1550, in the look up to tick 1559; 30 more come while stopping.
    apparatus_.ticks_after_stop = 30;
    planTrials({successScript()});
    ASSERT_TRUE(runSession());
    const auto& ticks = sink_.ticks.at(AttemptId{1});
    ASSERT_EQ(ticks.size(), 1590u);
    for (std::size_t i = 0; i < ticks.size(); ++i) ASSERT_EQ(ticks[i], static_cast<std::int64_t>(i));
    const auto last_append = std::find(log_.rbegin(), log_.rend(), "appendRecords");
    const auto finish = std::find(log_.rbegin(), log_.rend(), "finishAttempt");
    EXPECT_GT(last_append, finish);
}

TEST_F(SessionTest, SessionTimeIsTheTicksOfAllAttemptsEndToEnd) {
    // Truth: closed form. Each attempt makes 1560 ticks (78 looks).
    planTrials({successScript(), successScript()});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.starts[0].start_ns, 0);
    EXPECT_EQ(sink_.starts[1].start_ns, 1560 * kMs);
    EXPECT_EQ(sink_.ends[1].end_ns, (1560 + kSuccessTick) * kMs);
    EXPECT_EQ(sink_.session_end_ns, 2 * 1560 * kMs);
}

TEST_F(SessionTest, AttemptCarriesItsTrialItsParametersAndTheStages) {
    // Truth: invariant
    planTrials({successScript(), successScript()});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.starts[1].trial_index, 1);
    EXPECT_EQ(sink_.starts[1].attempt_no, 1);
    EXPECT_EQ(sink_.starts[1].params_json, R"({"name":"hard"})");
    ASSERT_EQ(sink_.starts[1].stages.size(), 1u);
    EXPECT_EQ(sink_.starts[1].stages[0].name, "query");
}

TEST_F(SessionTest, SeedBelongsToParticipantTrialAndAttemptAndNotToWhatRanBefore) {
    // Truth: invariant: a session that resumes at its second trial draws what the uninterrupted one drew.
    planTrials({successScript(), successScript()});
    ASSERT_TRUE(runSession());
    ASSERT_EQ(apparatus_.seeds.size(), 2u);
    EXPECT_EQ(apparatus_.trials_before, (std::vector<std::int64_t>{0, 1}));
    EXPECT_NE(apparatus_.seeds[0], apparatus_.seeds[1]);
    EXPECT_EQ(sink_.starts[1].seed, apparatus_.seeds[1]);
    const SessionSetup resumed{plan::FrozenPlan(plan_), {trials_[1]}, "P001", 7, false};
    EXPECT_EQ(attemptSeed(resumed, trials_[1], 1), apparatus_.seeds[1]);
    EXPECT_NE(attemptSeed(resumed, trials_[1], 2), apparatus_.seeds[1]);
    const SessionSetup other{plan::FrozenPlan(plan_), {trials_[1]}, "P002", 7, false};
    EXPECT_NE(attemptSeed(other, trials_[1], 1), apparatus_.seeds[1]);
    const SessionSetup again{plan::FrozenPlan(plan_), {trials_[1]}, "P001", 7, false, 2};
    EXPECT_NE(attemptSeed(again, trials_[1], 1), apparatus_.seeds[1]);
}

TEST_F(SessionTest, TimeOutCountsFromTheStartOfTheTrial) {
    // Truth: closed form. Started at tick 100, limit 2 s.
    for (auto& condition : plan_.conditions) condition.task.timeout = 2.0;
    planTrials({script(4000, 100, kNever)});
    ASSERT_TRUE(runSession());
    const AttemptEnd& end = sink_.ends.at(0);
    EXPECT_EQ(end.outcome, Outcome::Timeout);
    EXPECT_TRUE(end.valid);
    EXPECT_EQ(end.end_ns, 2100 * kMs);
    EXPECT_FALSE(value(end, "completion_time_s"));
    EXPECT_EQ(eventTimes(), (std::vector<std::string>{"trial_started@100", "timeout@2100"}));
}

TEST_F(SessionTest, SuccessInTheTickOfTheTimeOutIsASuccess) {
    // Truth: closed form. 1550 - 100 = 1450 ticks; one tick less is too late.
    for (const auto& [timeout, outcome] : {std::pair{1.450, Outcome::Success}, std::pair{1.449, Outcome::Timeout}}) {
        for (auto& condition : plan_.conditions) condition.task.timeout = timeout;
        trials_.clear();
        planTrials({successScript()});
        ASSERT_TRUE(runSession());
        EXPECT_EQ(sink_.ends.back().outcome, outcome);
    }
}

TEST_F(SessionTest, PartThatLiesInTheBoreBeforeTheStartDoesNotSucceedBeforeIt) {
    // Truth: closed form. Start at tick 2000: the rule sees its first record there, 50 + 500 ticks later it is met.
    planTrials({script(4000, 2000, 0)});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.ends.at(0).end_ns, 2550 * kMs);
}

TEST_F(SessionTest, AttemptWithoutStartPoseIsAbortedInvalidAndTheSessionGoesOn) {
    // Truth: closed form. Limit 60 s.
    planTrials({script(61'000, kNever, kNever), successScript()});
    ASSERT_TRUE(runSession());
    ASSERT_EQ(sink_.ends.size(), 2u);
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Aborted);
    EXPECT_FALSE(sink_.ends[0].valid);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "start pose not reached");
    EXPECT_EQ(sink_.ends[0].end_ns, 60'000 * kMs);
    EXPECT_FALSE(value(sink_.ends[0], "trial_time_s"));
    EXPECT_EQ(sink_.events[0].event, "aborted");
    EXPECT_EQ(sink_.events[0].payload_json, R"({"reason":"start pose not reached"})");
    EXPECT_EQ(sink_.ends[1].outcome, Outcome::Success);
    EXPECT_EQ(sink_.complete, false) << "a main trial lacks";
}

TEST_F(SessionTest, LostRecordsMakeTheAttemptInvalid) {
    // Truth: closed form. Three ticks are missing before the insertion.
    Records records = successScript();
    records.erase(records.begin() + 500, records.begin() + 503);
    planTrials({records});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.ends.at(0).outcome, Outcome::Success);
    EXPECT_FALSE(sink_.ends[0].valid);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "3 tick records lost");
    EXPECT_EQ(sink_.ends[0].health.dropped_records, 3);
}

/// The same script after `missed` cycles before `tick`.
Records withMissed(Records records, std::size_t tick, std::uint32_t missed) {
    records[tick].periods += missed;
    records[tick].status |= kOverrun;
    return records;
}

TEST_F(SessionTest, MissedCyclesStretchTheTrialAndTheSession) {
    // Truth: closed form. 10 cycles are missed before tick 500: what happens later is 10 ms later, the trial 10 ms
    // longer; 10 of 1460 cycles are 0.7 %, less than the 1 % that make an attempt invalid.
    planTrials({withMissed(successScript(), 500, 10), successScript()});
    ASSERT_TRUE(runSession());
    const AttemptEnd& end = sink_.ends.at(0);
    EXPECT_EQ(end.outcome, Outcome::Success);
    EXPECT_TRUE(end.valid) << end.invalid_reason;
    EXPECT_EQ(end.end_ns, (kSuccessTick + 10) * kMs);
    EXPECT_DOUBLE_EQ(value(end, "trial_time_s").value(), 1.46);
    EXPECT_DOUBLE_EQ(value(end, "approach_time_s").value(), 0.91);
    const auto times = eventTimes();
    EXPECT_EQ(std::vector<std::string>(times.begin(), times.begin() + 4),
              (std::vector<std::string>{"trial_started@100", "first_contact@1010", "engaged@1010", "success@1560"}));
    EXPECT_EQ(sink_.starts.at(1).start_ns, 1570 * kMs);
}

TEST_F(SessionTest, TooManyMissedCyclesMakeTheAttemptInvalid) {
    // Truth: closed form. 20 of 1470 cycles are 1.4 %; before the start of the trial they do no harm; the protocol may
    // allow more.
    planTrials({withMissed(successScript(), 500, 20), withMissed(successScript(), 50, 20)});
    ASSERT_TRUE(runSession());
    EXPECT_FALSE(sink_.ends.at(0).valid);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "loop: 20 of 1470 cycles missed");
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Success);
    EXPECT_TRUE(sink_.ends.at(1).valid) << sink_.ends[1].invalid_reason;
    EXPECT_DOUBLE_EQ(value(sink_.ends[1], "trial_time_s").value(), 1.45);
    plan_.max_missed_share = 0.02;
    trials_.clear();
    planTrials({withMissed(successScript(), 500, 20)});
    ASSERT_TRUE(runSession());
    EXPECT_TRUE(sink_.ends.at(2).valid) << sink_.ends[2].invalid_reason;
}

/// The same script without usable input from `first` on.
Records withRejected(Records records, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) records[i].status |= kInputRejected;
    return records;
}

TEST_F(SessionTest, TicksWithoutUsableInputCountAsMissedCycles) {
    // Truth: closed form. The trial starts at tick 100: of 20 ticks from 90 on ten count, 0.7 % of 1450; 15 are more
    // than 1 %, as are ten and five missed cycles of then 1455.
    planTrials({withRejected(successScript(), 90, 20), withRejected(successScript(), 500, 15),
                withMissed(withRejected(successScript(), 500, 10), 700, 5)});
    ASSERT_TRUE(runSession());
    EXPECT_TRUE(sink_.ends.at(0).valid) << sink_.ends[0].invalid_reason;
    EXPECT_EQ(sink_.ends.at(1).invalid_reason, "no usable device input in 15 ticks, and 0 of 1450 cycles missed");
    EXPECT_EQ(sink_.ends.at(2).invalid_reason, "no usable device input in 10 ticks, and 5 of 1455 cycles missed");
}

TEST_F(SessionTest, TimeOutCountsMissedCycles) {
    // Truth: closed form. 2 s after tick 100 is tick 2090 if 10 cycles were missed on the way.
    for (auto& condition : plan_.conditions) condition.task.timeout = 2.0;
    planTrials({withMissed(script(4000, 100, kNever), 600, 10)});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.ends.at(0).outcome, Outcome::Timeout);
    EXPECT_EQ(sink_.ends[0].end_ns, 2100 * kMs);
    EXPECT_DOUBLE_EQ(value(sink_.ends[0], "trial_time_s").value(), 2.0);
    EXPECT_EQ(sink_.ticks.at(AttemptId{1}).size(), 2100u);  // looks of 20 ticks: 0…2090 is in the 105th
}

TEST_F(SessionTest, LatchedOutputAbortsTheAttempt) {
    // Truth: invariant: without force nothing that follows may count as success.
    Records records = successScript();
    for (std::size_t i = 900; i < records.size(); ++i) records[i].status |= kNonFiniteLatched;
    planTrials({records});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(sink_.ends.at(0).outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends[0].end_ns, 900 * kMs);
    EXPECT_FALSE(sink_.ends[0].valid);
}

TEST_F(SessionTest, DeadLoopAbortsTheAttemptAndEndsTheSession) {
    // Truth: invariant: a loop that delivers nothing must not hold the session for ever.
    planTrials({script(200, 100, kNever), successScript()});
    const auto result = runSession();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().at(0).message, "the haptic loop delivers no records");
    ASSERT_EQ(sink_.ends.size(), 1u);
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends[0].invalid_reason, "the loop delivers no records");
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(SessionTest, FailedPreparationEndsTheSessionAndKeepsWhatIsFinished) {
    // Truth: invariant
    apparatus_.fail_prepare_at = 1;
    planTrials({successScript(), successScript(), successScript()});
    const auto result = runSession();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().at(0).message, "the mesh is gone");
    EXPECT_EQ(sink_.starts.size(), 1u);
    EXPECT_EQ(sink_.ends.size(), 1u);
    EXPECT_EQ(acknowledged_, std::vector<AttemptId>{AttemptId{1}});
    EXPECT_EQ(sink_.events.back().event, "session_failed");
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(SessionTest, AttemptThatCannotBeStoredIsNeverStarted) {
    // Truth: invariant
    sink_.fail_start_at = 0;
    planTrials({successScript()});
    const auto result = runSession();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().at(0).message, "the database is locked");
    EXPECT_EQ(std::count(log_.begin(), log_.end(), "start"), 0);
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(SessionTest, AttemptThatIsNotDurableIsNotAcknowledged) {
    // Truth: invariant
    sink_.fail_finish_at = 1;
    planTrials({successScript(), successScript(), successScript()});
    const auto result = runSession();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().at(0).message, "the disk is full");
    EXPECT_EQ(acknowledged_, std::vector<AttemptId>{AttemptId{1}});
    EXPECT_EQ(std::count(log_.begin(), log_.end(), "stop"), 2);
    EXPECT_EQ(sink_.starts.size(), 2u);
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(SessionTest, UnknownTargetIsAnErrorThatNamesIt) {
    // Truth: invariant
    plan_.conditions[0].task.target = "disc";
    planTrials({successScript()});
    const auto result = runSession();
    ASSERT_FALSE(result);
    EXPECT_EQ(result.errors().at(0).value, "disc");
}

TEST_F(SessionTest, AnInterruptionKeepsTheRunningTrialAsAborted) {
    // Truth: closed form: two looks of 20 ticks were taken of the second trial, which had not started by then.
    planTrials({successScript(), successScript()});
    Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, {});
    while (sink_.ends.empty()) session.advance();
    for (int i = 0; i < 3; ++i) session.advance();
    session.interrupt("interrupted");
    EXPECT_EQ(session.state(), SessionState::Interrupted);
    EXPECT_EQ(session.advance(), SessionState::Interrupted) << "it is over";
    ASSERT_EQ(sink_.ends.size(), 2u);
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Success);
    EXPECT_EQ(sink_.ends[1].outcome, Outcome::Aborted);
    EXPECT_EQ(sink_.ends[1].invalid_reason, "interrupted");
    EXPECT_FALSE(sink_.ends[1].valid);
    EXPECT_EQ(sink_.ticks[AttemptId{2}].size(), 40u);
    EXPECT_EQ(sink_.complete, false);
    EXPECT_EQ(sink_.events.back().event, "session_interrupted");
    EXPECT_EQ(sink_.events.back().payload_json, R"({"reason":"interrupted"})");
    EXPECT_EQ(std::count(log_.begin(), log_.end(), "stop"), 2) << "the motors are off";
}

TEST_F(SessionTest, AnInterruptionAfterTheLastTrialLeavesTheSessionComplete) {
    // Truth: invariant: nothing was left to do.
    planTrials({successScript()});
    Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, {});
    while (sink_.ends.empty()) session.advance();
    session.interrupt("interrupted");
    EXPECT_EQ(session.state(), SessionState::Complete);
    EXPECT_EQ(sink_.complete, true);
}

TEST_F(SessionTest, SessionThatIsDroppedInATrialStopsTheApparatus) {
    // Truth: invariant: motors never stay on behind a session that is gone.
    planTrials({successScript()});
    {
        Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, {});
        EXPECT_EQ(session.advance(), SessionState::InTrial);
        EXPECT_EQ(session.advance(), SessionState::InTrial);
        EXPECT_EQ(std::count(log_.begin(), log_.end(), "stop"), 0);
    }
    EXPECT_EQ(log_.back(), "stop");
}

TEST_F(SessionTest, WherePartsArePickedUpOverlapsAreMeasuredByAllRecordsOfTheAttempt) {
    // Truth: definition. The trial starts at tick 100; a hand may carry parts before.
    plan_.conditions[1].scene.effects.pick.reach = 0.005;
    planTrials({successScript(), successScript()});
    ASSERT_TRUE(runSession());
    EXPECT_EQ(apparatus_.overlaps_from, (std::vector<std::int64_t>{100, 0}));
    EXPECT_EQ(value(sink_.ends[0], "path_length_m"), value(sink_.ends[1], "path_length_m"));
    EXPECT_EQ(value(sink_.ends[0], "trial_time_s"), value(sink_.ends[1], "trial_time_s"));
}

}  // namespace
}  // namespace passung::session
