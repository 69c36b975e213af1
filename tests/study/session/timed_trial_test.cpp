#include <gtest/gtest.h>

#include "study/session/recompute.h"
#include "tests/study/session/scripted_session.h"

// Trials that the program does not time: the experimenter's clock for real parts, and the clock alone.

namespace passung::session {
namespace {

using Kind = CommandKind;

class TimedTrial : public SessionTest {
protected:
    void begin(plan::TimedBy timed_by, std::size_t trials = 1, TrialTimer* timer = nullptr) {
        for (auto& condition : plan_.conditions) {
            condition.timed_by = timed_by;
            condition.task.timeout = 3.0;
        }
        planTrials(std::vector<Records>(trials, script(9000, kNever, kNever)));
        SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, false};
        setup.timer = timer;
        session_.emplace(std::move(setup), apparatus_, sink_, SessionListener{});
    }
    Reply tell(Kind kind) { return session_->command({.kind = kind}); }
    void look(int times) {
        for (int i = 0; i < times; ++i) session_->advance();
    }
    /// Judges the first attempt once more from its ticks.
    Judgement again(const Records& records) const {
        StoredEnd stored{sink_.ends.front().outcome, sink_.ends.front().end_ns / kMs, {}, sink_.starts.front().seed};
        for (const Event& event : sink_.events)
            if (event.event == "trial_started") stored.start_time = event.t_ns / kMs;
        return *judgeAgain(plan_.conditions.front(), std::array{records}, stored);
    }
    std::optional<Session> session_;
};

TEST_F(TimedTrial, TheExperimenterStartsAndStopsTheClock) {
    // Truth: closed form: the trial is begun, 10 looks of 20 ticks, start, 50 looks, done: from tick 200 to tick 1200.
    begin(plan::TimedBy::Experimenter);
    look(11);
    EXPECT_EQ(tell(Kind::Done).text, "the trial's clock has not been started");
    EXPECT_EQ(tell(Kind::Start).text, "the clock of trial 1 runs");
    EXPECT_FALSE(tell(Kind::Start).accepted);
    look(50);
    EXPECT_EQ(tell(Kind::Done).text, "trial 1 has succeeded");
    EXPECT_FALSE(tell(Kind::Failed).accepted) << "it is over";
    ASSERT_TRUE(session_->run());
    ASSERT_EQ(sink_.ends.size(), 1u);
    const AttemptEnd& end = sink_.ends.front();
    EXPECT_EQ(end.outcome, Outcome::Success);
    EXPECT_TRUE(end.valid);
    EXPECT_EQ(end.end_ns, 1200 * kMs);
    EXPECT_EQ(value(end, "trial_time_s"), 1.0);
    EXPECT_EQ(value(end, "completion_time_s"), std::nullopt);
    EXPECT_EQ(value(end, "path_length_m"), std::nullopt) << "nothing was in the device";
    const auto events = eventTimes();
    EXPECT_NE(std::find(events.begin(), events.end(), "trial_started@200"), events.end());
    EXPECT_NE(std::find(events.begin(), events.end(), "success@1200"), events.end());
    const Judgement judged = again(script(9000, kNever, kNever));
    EXPECT_EQ(judged.outcome, Outcome::Success);
    for (std::size_t i = 0; i < judged.measures.size(); ++i)
        EXPECT_EQ(judged.measures[i].value, end.measures[i].value) << judged.measures[i].name;
}

TEST_F(TimedTrial, AFailureIsOneAndATimeOutEndsItAlone) {
    // Truth: closed form: the second trial's clock starts at its tick 0 and runs 3 s.
    begin(plan::TimedBy::Experimenter, 2);
    look(1);
    ASSERT_TRUE(tell(Kind::Start).accepted);
    look(5);
    ASSERT_TRUE(tell(Kind::Failed).accepted);
    look(2);
    ASSERT_EQ(sink_.ends.size(), 1u);
    EXPECT_EQ(sink_.ends[0].outcome, Outcome::Failure);
    EXPECT_TRUE(sink_.ends[0].valid);
    EXPECT_EQ(again(script(9000, kNever, kNever)).outcome, Outcome::Failure);
    ASSERT_TRUE(tell(Kind::Start).accepted);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(sink_.ends[1].outcome, Outcome::Timeout);
    EXPECT_EQ(value(sink_.ends[1], "trial_time_s"), 3.0);
}

TEST_F(TimedTrial, WaitsForTheExperimenterHoweverLong) {
    // Truth: invariant: a hand that never comes to the start pose aborts a trial that the program times, no other.
    begin(plan::TimedBy::Experimenter);
    apparatus_.scripts.front() = script(TrialCourse::kStartLimit + 500, kNever, kNever);
    look(static_cast<int>(TrialCourse::kStartLimit / Session::kTicksPerPoll) + 10);
    EXPECT_EQ(session_->state(), SessionState::InTrial);
    session_->interrupt("enough");
    EXPECT_EQ(sink_.ends.front().outcome, Outcome::Aborted);
}

TEST_F(TimedTrial, CommandsOfTheClockAreRefusedWhereTheProgramTimes) {
    // Truth: invariant
    planTrials({successScript()});
    session_.emplace(SessionSetup{plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_,
                     SessionListener{});
    look(3);
    EXPECT_FALSE(tell(Kind::Start).accepted);
    EXPECT_EQ(tell(Kind::Done).text, "no trial runs that the experimenter times");
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(sink_.ends.front().outcome, Outcome::Success);
    EXPECT_EQ(value(sink_.ends.front(), "secondary_stimuli"), std::nullopt);
}

TEST_F(TimedTrial, TheClockAloneGivesItsTimeAndASuccess) {
    // Truth: closed form: 3 s from the first tick on.
    begin(plan::TimedBy::Clock);
    ASSERT_TRUE(session_->run());
    EXPECT_EQ(sink_.ends.front().outcome, Outcome::Success);
    EXPECT_EQ(value(sink_.ends.front(), "trial_time_s"), 3.0);
    EXPECT_EQ(again(script(9000, kNever, kNever)).outcome, Outcome::Success);
}

/// Says start after 500 periods and done after 1500.
class FixedTimer : public TrialTimer {
public:
    void begin(const plan::Condition&, std::uint64_t, std::int64_t) override {}
    std::optional<Command> commandAt(std::int64_t periods) override {
        const int due = periods >= 1500 ? 2 : periods >= 500 ? 1 : 0;
        if (due <= said_) return std::nullopt;
        return Command{.kind = ++said_ == 1 ? Kind::Start : Kind::Done, .source = "simulated"};
    }

private:
    int said_ = 0;
};

TEST_F(TimedTrial, ATimerSpeaksForTheExperimenterAndIsLoggedAsItself) {
    // Truth: closed form: after tick 499 25 looks are over (ticks 0 to 499), the record after is tick 500.
    FixedTimer timer;
    begin(plan::TimedBy::Experimenter, 1, &timer);
    ASSERT_TRUE(session_->run());
    EXPECT_NEAR(*value(sink_.ends.front(), "trial_time_s"), 1.0, 0.020 + 1e-9) << "to one look";
    std::size_t simulated = 0;
    for (const Event& event : sink_.events) simulated += event.source == "simulated" ? 1 : 0;
    EXPECT_EQ(simulated, 2u);
}

TEST_F(TimedTrial, ASecondaryTaskIsScoredAndScoredAlikeAgain) {
    // Truth: closed form: 3 s of clock, stimuli 0.6 to 0.8 s apart: 3 or 4 can be
    // missed; with a press 200 ms after the first one it is a hit.
    for (auto& condition : plan_.conditions) condition.secondary = {plan::Stimulus::Audio, 0.6, 0.8, 0.3, 0.1, 0.5, 1};
    begin(plan::TimedBy::Clock);
    const std::uint64_t seed =
        attemptSeed(SessionSetup{plan::FrozenPlan(plan_), trials_, "P001", 7, false}, trials_.front(), 1);
    const std::int64_t first = measures::StimulusTimes({0.6, 0.8, 0.3, 0.1, 0.5, 1}, seed).next();
    Records& records = apparatus_.scripts.front();
    for (std::int64_t tick = first + 200; tick < first + 260; ++tick)
        records[static_cast<std::size_t>(tick)].input_flags |= 1u << 8;
    const Records copy = records;
    ASSERT_TRUE(session_->run());
    const AttemptEnd& end = sink_.ends.front();
    ASSERT_GE(end.detections.size(), 4u);
    EXPECT_EQ(end.detections[0],
              (measures::Detection{measures::DetectionResult::Hit, first, first + 200, first + 200}));
    EXPECT_EQ(end.detections[1].result, measures::DetectionResult::Miss);
    EXPECT_EQ(value(end, "secondary_response_time_s"), 0.2);
    EXPECT_EQ(value(end, "secondary_false_alarms"), 0.0);
    EXPECT_EQ(again(copy).detections, end.detections);
}

TEST_F(TimedTrial, InstructionsAreLoggedAtTheirMoments) {
    // Truth: closed form. Nobody is there to show them.
    plan_.blocks = {{.name = "first"}, {.name = "second"}};
    plan_.instructions = {{plan::ShowAt::SessionEnd, "", "thanks", ""},
                          {plan::ShowAt::SessionStart, "", "welcome", "start.png"},
                          {plan::ShowAt::BeforeBlock, "second", "noise", ""}};
    begin(plan::TimedBy::Clock, 3);
    for (std::size_t i = 0; i < 3; ++i) {
        trials_[i].block = i == 0 ? "first" : "second";
        trials_[i].block_index = i == 0 ? 0 : 1;
    }
    session_.emplace(SessionSetup{plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_,
                     SessionListener{});
    ASSERT_TRUE(session_->run());
    std::vector<std::string> shown;
    for (const Event& event : sink_.events)
        if (event.event == "instruction_not_shown")
            shown.push_back(event.payload_json + std::to_string(event.t_ns / kMs));
    ASSERT_EQ(shown.size(), 3u);
    EXPECT_NE(shown[0].find("welcome"), std::string::npos);
    EXPECT_NE(shown[0].find("start.png"), std::string::npos);
    EXPECT_NE(shown[1].find("noise"), std::string::npos);
    EXPECT_TRUE(shown[1].ends_with("3020")) << shown[1] << ": after the first block's only trial";
    EXPECT_NE(shown[2].find("thanks"), std::string::npos);
}

}  // namespace
}  // namespace passung::session
