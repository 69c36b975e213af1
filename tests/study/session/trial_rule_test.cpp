#include "study/session/trial_rule.h"

#include <gtest/gtest.h>

#include "study/session/rendered_scenes.h"
#include "study/session/trial_course.h"

namespace passung::session {
namespace {

/// Follows records until the trial ends or there are no more; the events as "name@period".
struct Followed {
    TrialState state;
    std::vector<std::string> events;
    measures::TrialContext context;
};

template <class MakeRecord>
Followed follow(const plan::Task& task, std::int64_t ticks, MakeRecord at, std::uint64_t seed = 1) {
    plan::Condition condition;
    condition.task = task;
    TrialCourse course(condition, Pose{}, seed);
    std::vector<TrialEvent> events;
    for (std::int64_t tick = 0; tick < ticks && !course.ended(); ++tick) {
        TickRecord record;
        record.proxy_quaternion = {1, 0, 0, 0};
        at(tick, record);
        record.tick = tick;
        course.follow(record, events);
    }
    const TrialState state = course.state();
    if (!course.ended()) course.abort(ticks, "", events);
    std::vector<std::string> texts;
    for (const TrialEvent& event : events) texts.push_back(std::string(event.name) + "@" + std::to_string(event.time));
    return {state, texts, course.context()};
}

using Events = std::vector<std::string>;

plan::Task pairTask(double answer = 0.5) {
    plan::Task task;
    task.timeout = 0.3;  // not the pair's: it times itself
    task.form = plan::DiscriminationPairTask{.interval = 0.1, .answer = answer, .question = "Which?"};
    return task;
}

/// Engaged in ticks 10 … 109 and 200 … 299.
void intervals(std::int64_t tick, TickRecord& record) {
    if ((tick >= 10 && tick < 110) || (tick >= 200 && tick < 300)) record.status |= kEngaged;
}

TEST(TrialRule, APairEndsWithItsAnswer) {
    // Truth: closed form
    const auto pair = follow(pairTask(), 1000, [](std::int64_t tick, TickRecord& record) {
        intervals(tick, record);
        if (tick >= 350) record.input_flags |= 2u << 8;
    });
    EXPECT_EQ(pair.state, TrialState::Succeeded);
    EXPECT_EQ(pair.events, (Events{"trial_started@10", "interval_ended@110", "interval_started@200",
                                   "interval_ended@300", "success@350"}));
    EXPECT_EQ(pair.context.start_tick, 10);
    EXPECT_EQ(pair.context.end_tick, 350);
}

TEST(TrialRule, APairWithoutAnswerTimesOutAfterItsQuestion) {
    // Truth: closed form: 500 periods after tick 300
    const auto pair = follow(pairTask(), 2000, intervals);
    EXPECT_EQ(pair.state, TrialState::TimedOut);
    EXPECT_EQ(pair.events.back(), "timeout@800");
}

TEST(TrialRule, AHandThatDoesNotComeBackAbortsThePair) {
    // Truth: closed form: a minute after the first interval
    const auto pair = follow(pairTask(), 70'000, [](std::int64_t tick, TickRecord& record) {
        if (tick >= 10 && tick < 110) record.status |= kEngaged;
    });
    EXPECT_EQ(pair.state, TrialState::Aborted);
    EXPECT_EQ(pair.events.back(), "aborted@60110");
}

TEST(TrialRule, APairsIntervalsFollowTheAttemptsSeed) {
    // Truth: invariant: about half of many attempts have the comparison first; scenes and measures agree on which.
    plan::Condition condition;
    condition.task = pairTask();
    condition.scene.contact.stiffness = 100.0;
    condition.comparison = condition.scene;
    condition.comparison->contact.stiffness = 200.0;
    int first = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        const auto scenes = renderedScenes(condition, seed);
        ASSERT_EQ(scenes.size(), 3u);
        const auto comparison = static_cast<std::size_t>(comparisonInterval(seed)) - 1;
        EXPECT_EQ(scenes[comparison].spec.contact.stiffness, 200.0);
        EXPECT_EQ(scenes[1 - comparison].spec.contact.stiffness, 100.0);
        EXPECT_EQ(scenes[0].periods, 100);
        EXPECT_EQ(scenes[1].periods, 100);
        first += comparison == 0 ? 1 : 0;
        measures::TrialContext context;
        TrialRule(condition.task, condition.scene, Pose{}, seed).describe(context);
        EXPECT_EQ(std::get<measures::PairFacts>(context.form).comparison_interval, comparisonInterval(seed));
    }
    EXPECT_NEAR(first, 500, 80);  // five standard deviations of a fair coin
    condition.task.form = plan::PegInHoleTask{};
    EXPECT_EQ(renderedScenes(condition, 3).size(), 1u);
}

TEST(TrialRule, APassageIsDoneOnceTheHeldPartIsThrough) {
    // Truth: closed form: 1 mm a tick from 10 mm above; the mouth at tick 10, 20 mm below it and more at tick 31.
    plan::Task task;
    task.form = plan::NarrowPassageTask{0.0205, 0.01};
    const auto passage = follow(task, 100, [](std::int64_t tick, TickRecord& record) {
        record.status |= kEngaged;
        record.proxy_position_m[2] = 1e-3f * static_cast<float>(10 - tick);
    });
    EXPECT_EQ(passage.state, TrialState::Succeeded);
    EXPECT_EQ(passage.events, (Events{"trial_started@0", "passage_entered@10", "success@31"}));
}

TEST(TrialRule, ALineIsDoneWithTheAskedShare) {
    // Truth: closed form: 100 mm, half of it asked, a millimetre a tick
    plan::Task task;
    task.form = plan::ContourFollowingTask{{Vec3::Zero(), Vec3(0.1, 0, 0)}, 0.005, 0.5005, 2.0};
    const auto line = follow(task, 200, [](std::int64_t tick, TickRecord& record) {
        record.status |= kEngaged;
        record.proxy_position_m[0] = 1e-3f * static_cast<float>(tick);
    });
    EXPECT_EQ(line.state, TrialState::Succeeded);
    EXPECT_EQ(line.events.back(), "success@51");
}

TEST(TrialRule, APlacementIsJudgedWhenItIsConfirmed) {
    // Truth: closed form: 5 mm allowed; 4 mm away at the confirmation, or 6 mm.
    plan::Task task;
    task.form = plan::FreePlacementTask{Pose{}, 0.005, 0.1, false};
    for (const float away : {0.004f, 0.006f}) {
        const auto placed = follow(task, 200, [away](std::int64_t tick, TickRecord& record) {
            record.status |= kEngaged;
            record.proxy_position_m[0] = tick < 100 ? 0.0f : away;
            if (tick >= 120) record.input_flags |= 1u << 8;
        });
        EXPECT_EQ(placed.state, away < 0.005f ? TrialState::Succeeded : TrialState::Failed);
        EXPECT_EQ(placed.events.back(), away < 0.005f ? "success@120" : "failure@120");
        EXPECT_EQ(placed.context.outcome, away < 0.005f ? measures::Outcome::Success : measures::Outcome::Failure);
    }
    // A button of the scene's effects confirms nothing.
    std::get<plan::FreePlacementTask>(task.form).other_buttons = 2u;
    const auto clutched = follow(task, 200, [](std::int64_t tick, TickRecord& record) {
        record.status |= kEngaged;
        record.input_flags |= tick >= 140 ? 3u << 8 : tick >= 120 ? 2u << 8 : 0u;
    });
    EXPECT_EQ(clutched.events.back(), "success@140");
    const auto waiting = follow(task, 40'000, [](std::int64_t, TickRecord& record) { record.status |= kEngaged; });
    EXPECT_EQ(waiting.events.back(), "timeout@30000");
}

}  // namespace
}  // namespace passung::session
