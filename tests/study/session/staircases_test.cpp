#include "study/session/staircases.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/random.h"
#include "study/session/resume.h"
#include "study/session/staircase_text.h"
#include "tests/study/session/scripted_session.h"

namespace passung::session {
namespace {

/// A staircase over the levels 1 … 9 in place of the conditions "soft" and "hard" of one block.
class StaircasesTest : public SessionTest {
protected:
    StaircasesTest() {
        plan::Staircase staircase;
        staircase.name = "time";
        staircase.key = "task.hold_s";
        staircase.measure = "trial_time_s";
        staircase.threshold = 1.5;
        for (int level = 1; level <= 9; ++level) staircase.levels.push_back(level);
        design::AdaptiveParams params;
        params.levels = staircase.levels;
        params.low = 1.0;
        params.high = 9.0;
        params.step_down = params.step_up = 1.5;
        params.down_after = 1;
        params.max_trials = 4;
        params.skip_reversals = 0;
        for (const auto& [name, start] : {std::pair("down", 9.0), std::pair("up", 1.0)}) {
            params.start = start;
            staircase.tracks.push_back({name, params});
        }
        staircase.catch_trials = 2;
        staircase.catch_level = 9.0;
        plan_.first_variant = 2;
        for (const char* name : {"soft", "hard"}) {
            staircase.first_variant.push_back(plan_.conditions.size());
            for (int level = 1; level <= 9; ++level) {
                plan_.conditions.push_back(plan_.conditions[name == std::string("soft") ? 0 : 1]);
                plan_.conditions.back().name += "@" + std::to_string(level);
            }
        }
        plan_.blocks[0].adaptive = true;
        plan_.staircases.push_back(staircase);
        for (int i = 0; i < 20; ++i) {
            design::PlannedTrial trial{i, 0, "main", i, "adaptive", static_cast<std::size_t>(i % 2), i / 2 + 1};
            trials_.push_back(trial);
        }
    }

    /// A trial that ends long (1) or soon (0) after its start: above or below the staircase's threshold.
    static Records trialOf(char answer) { return script(2200, 100, answer == '1' ? 1500 : 500); }

    /// Names of what is presented, one for each answer, from `resumed` on or from the beginning.
    std::vector<std::string> presented(const std::string& answers, std::optional<Resumption> resumed = {}) {
        log_.clear();
        apparatus_.scripts.clear();
        for (const char answer : answers) apparatus_.scripts.push_back(trialOf(answer));
        SessionSetup setup{plan::FrozenPlan(plan_), trials_, "P001", 7, false};
        setup.resumed = std::move(resumed);
        Session session(std::move(setup), apparatus_, sink_, {});
        while (!session.isOver() && (session.state() == SessionState::InTrial || !apparatus_.scripts.empty()))
            session.advance();
        whole_ = session.isWhole();
        if (whole_ && !session.isOver()) session.advance();
        std::vector<std::string> names;
        for (const std::string& line : log_)
            if (line.starts_with("prepare ")) names.push_back(line.substr(8));
        return names;
    }

    /// What the sink has of the first `count` attempts, as a database would give it back.
    std::vector<StoredAttempt> stored(std::size_t count) const {
        std::vector<StoredAttempt> attempts;
        for (std::size_t i = 0; i < count; ++i) {
            const AttemptStart& start = sink_.starts[i];
            StoredAttempt attempt{AttemptId{static_cast<std::int64_t>(i + 1)},
                                  static_cast<std::size_t>(start.trial_index), start.attempt_no, sink_.ends[i].outcome,
                                  sink_.ends[i].valid};
            const StaircaseAnswer& answer = *sink_.ends[i].staircase;
            if (!start.staircase->track.empty() && answer.positive)
                attempt.step = StoredStep{"time", start.staircase->track, start.staircase->level, *answer.positive};
            attempts.push_back(attempt);
        }
        return attempts;
    }

    bool whole_ = false;
    static constexpr const char* kAnswers = "10110100101101001011";
};

TEST_F(StaircasesTest, EveryTrackHasItsTrialsAndCatchTrialsTellNone) {
    // Truth: closed form: of each condition 2 tracks of 4 trials and 2 catch trials at level 9.
    EXPECT_EQ(presented(kAnswers).size(), 20u);
    EXPECT_TRUE(whole_);
    std::map<std::string, int> counts;
    for (const AttemptStart& start : sink_.starts) {
        const std::string& track = start.staircase->track;
        ++counts[plan_.conditions[start.staircase->condition].name.substr(0, 4) + track];
        if (track.empty()) {
            EXPECT_EQ(start.staircase->level, 9.0);
        }
    }
    EXPECT_EQ(counts, (std::map<std::string, int>{
                          {"hard", 2}, {"harddown", 4}, {"hardup", 4}, {"soft", 2}, {"softdown", 4}, {"softup", 4}}));
}

TEST_F(StaircasesTest, ATrackFollowsItsOwnAnswersOnly) {
    // Truth: closed form: 1.5 down from 9 after each long trial, rounded to a level half-way down: 9, 7.5 -> 7 or 8 ...
    presented("11111111111111111111");
    for (const char* condition : {"soft", "hard"}) {
        std::vector<double> wanted, levels;
        for (const AttemptStart& start : sink_.starts)
            if (start.staircase->track == "down" &&
                plan_.conditions[start.staircase->condition].name.starts_with(condition)) {
                wanted.push_back(start.staircase->wanted);
                levels.push_back(start.staircase->level);
            }
        EXPECT_EQ(levels, (std::vector<double>{9, 7, 5, 3})) << condition;
        EXPECT_EQ(wanted, (std::vector<double>{9, 7.5, 5.5, 3.5})) << "steps start from what was presented";
    }
}

TEST_F(StaircasesTest, AKilledSessionGoesOnAsTheUninterruptedOne) {
    // Truth: invariant: wherever it was killed, even in the middle of a trial.
    const auto uninterrupted = presented(kAnswers);
    const auto starts = sink_.starts;
    const auto ends = sink_.ends;
    for (std::size_t done = 0; done < 20; ++done) {
        sink_.starts = starts;
        sink_.ends = ends;
        auto attempts = stored(done);
        attempts.push_back(
            {AttemptId{100}, static_cast<std::size_t>(starts[done].trial_index), 1, std::nullopt, false});
        const auto rest = presented(std::string(kAnswers).substr(done), resumption(plan_, trials_, attempts, true));
        EXPECT_EQ(rest, (std::vector<std::string>(uninterrupted.begin() + static_cast<std::ptrdiff_t>(done),
                                                  uninterrupted.end())))
            << done;
    }
}

TEST_F(StaircasesTest, TrialsThatNoTrackNeedsAreLeftOut) {
    // Truth: closed form: one reversal ends a track: its condition's trials end with the second track's.
    for (auto& track : plan_.staircases[0].tracks) track.params.max_reversals = 1;
    const auto names = presented(kAnswers);
    EXPECT_LT(names.size(), 20u);
    EXPECT_TRUE(whole_) << "they were not needed";
    EXPECT_EQ(sink_.complete, true);
}

TEST_F(StaircasesTest, AnAttemptThatDoesNotCountTellsNothing) {
    // Truth: closed form: the trial is presented once more, at the same level of the same track.
    plan_.blocks[0].on_timeout = plan::Repeat::Now;
    for (auto& condition : plan_.conditions) condition.task.timeout = 1.7;
    const auto names = presented("10");
    ASSERT_EQ(sink_.starts.size(), 2u);
    EXPECT_EQ(names[0], names[1]);
    EXPECT_EQ(sink_.starts[0].staircase->track, sink_.starts[1].staircase->track);
    EXPECT_FALSE(sink_.ends[0].staircase->positive);
    EXPECT_EQ(sink_.ends[1].staircase->positive, false);
}

TEST_F(StaircasesTest, ATrialThatGivesItsTrackNoAnswerIsRepeatedUpToTheMaximum) {
    // Truth: closed form: ticks are lost in the first attempts at the first two trials, in all three at the third; no
    // rule of the block repeats them. The track that lacks the third's answer never finishes.
    const auto lost = [] {
        Records records = trialOf('1');
        records.erase(records.begin() + 300);
        return records;
    };
    plan_.staircases[0].catch_trials = 0;
    trials_.resize(16);
    std::deque<Records> scripts(24, trialOf('1'));
    for (const std::size_t i : {0u, 1u, 2u, 18u, 19u}) scripts[i] = lost();
    apparatus_.scripts = scripts;
    Session session({plan::FrozenPlan(plan_), trials_, "P001", 7, false}, apparatus_, sink_, {});
    ASSERT_TRUE(session.run());
    std::vector<std::int64_t> ends;
    for (std::size_t i = 16; i < sink_.starts.size(); ++i)
        ends.push_back(sink_.starts[i].trial_index * 10 + sink_.starts[i].attempt_no);
    EXPECT_EQ(ends, (std::vector<std::int64_t>{2, 12, 22, 23}));
    EXPECT_FALSE(session.isWhole());
    EXPECT_EQ(sink_.complete, false);
}

TEST_F(StaircasesTest, AnAnswerThatIsTakenBackIsForgotten) {
    // Truth: closed form: the track asks for what it had asked for before.
    Staircases staircases(plan_, "P001", 7, 1);
    const auto first = staircases.next(trials_[0]);
    ASSERT_TRUE(first && !first->track.empty()) << "seed 7 begins with no catch trial";
    const auto answer = staircases.take(AttemptId{1}, trials_[0], *first, {{"trial_time_s", 3.0}}, true);
    EXPECT_EQ(answer.positive, true);
    EXPECT_NE(staircases.next(trials_[0])->wanted, first->wanted);
    staircases.forget(AttemptId{1});
    EXPECT_EQ(staircases.next(trials_[0])->wanted, first->wanted);
}

TEST_F(StaircasesTest, AMeasureThatIsNotThereIsNoAnswer) {
    // Truth: closed form
    Staircases staircases(plan_, "P001", 7, 1);
    const auto step = *staircases.next(trials_[0]);
    EXPECT_FALSE(staircases.take(AttemptId{1}, trials_[0], step, {{"trial_time_s", {}}}, true).positive);
    EXPECT_EQ(staircases.take(AttemptId{2}, trials_[0], step, {{"trial_time_s", 1.5}}, true).positive, false);
    plan_.staircases[0].above = false;
    EXPECT_EQ(staircases.take(AttemptId{3}, trials_[0], step, {{"trial_time_s", 1.4}}, true).positive, true);
}

TEST_F(StaircasesTest, IsDescribedInWords) {
    // Truth: regression (words for an experimenter)
    EXPECT_EQ(staircasesText(plan_),
              "Staircases\n"
              "  time  block main: task.hold_s from 1 to 9, 9 levels\n"
              "    1 up, 1 down, steps 1.5 up and 1.5 down; settles at 50 % positive\n"
              "    positive: trial_time_s above 1.5\n"
              "    tracks down from 9, up from 1, each of 4 trials for every condition; 2 catch trials at 9\n\n");
}

}  // namespace
}  // namespace passung::session
