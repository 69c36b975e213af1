#include "study/run/visible_task.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shape/shape.h"

namespace passung::run {
namespace {

using scene::stepBit;

/// Two hands that hold nothing, a plate with a bore, a peg for it that is drawn elsewhere, a block.
plan::Condition assembly() {
    plan::Condition condition;
    scene::SceneSpec& spec = condition.scene;
    spec.parts = {{.name = "plate", .geometry = shape::BorePlate{0.05, 0.05, 0.02, 0.0104, 0.02, 1e-3}, .X_WP = {}},
                  {.name = "peg", .geometry = shape::Peg{0.01, 0.04, 5e-4}, .X_WP = {}, .pickable = true},
                  {.name = "block", .geometry = shape::Box{0.02, 0.03, 0.01}, .X_WP = {}, .pickable = true}};
    spec.parts[1].X_WP.p = Vec3(0.1, 0.0, 0.0);
    spec.parts[1].shown_offset = Vec3(0.0, 0.003, 0.0);
    spec.start_gate.X_WH.p = Vec3(0.0, 0.0, 0.1);
    spec.other_hands.emplace_back().start_gate.X_WH.p = Vec3(0.0, 0.2, 0.1);
    spec.effects.pick = {.reach = 0.004, .button = 3, .on_press = true};
    spec.effects.pick.steps.resize(2);
    spec.effects.pick.steps[0].part = 1;
    spec.effects.pick.steps[0].into = 0;
    spec.effects.pick.steps[0].folds = 0;
    spec.effects.pick.steps[1].part = 2;
    spec.effects.pick.steps[1].after = stepBit(0);
    condition.task.form = plan::AssemblyTask{.steps = {{"peg", 0.015, 0}, {"block", 0.0, 1}}};
    return condition;
}

TEST(VisibleTask, EachHandKnowsHowFarEveryHandGets) {
    // Truth: closed form: a sigma.7 moves its handle in a ball of 75 mm, here at twice the scale; a clutch goes on and
    // on.
    plan::Condition condition = assembly();
    condition.device = "sigma7";
    condition.other_devices = {"sigma7"};
    condition.scene.registration.X_WB.p = Vec3(0.1, 0.2, 0.3);
    condition.scene.registration.scale = 2.0;
    condition.scene.other_hands[0].navigation.clutch.button = 2;
    const simulated::VisibleTask task = otherTask(condition, 1);
    const auto& reaches = std::get<simulated::AssembleGoal>(task.goal).reaches;
    ASSERT_EQ(reaches.size(), 2u);
    EXPECT_EQ(reaches[0].middle, Vec3(0.1, 0.2, 0.3));
    EXPECT_DOUBLE_EQ(reaches[0].radius, 0.15);
    EXPECT_TRUE(std::isinf(reaches[1].radius));
}

TEST(VisibleTask, AnAssemblyShowsEachHandItsStepsAndPartsWhereTheyAreDrawn) {
    // Truth: the scene and the task above, by hand.
    const plan::Condition condition = assembly();
    for (const std::size_t hand : {std::size_t{0}, std::size_t{1}}) {
        const simulated::VisibleTask task = hand == 0 ? visibleTask(condition) : otherTask(condition, hand);
        EXPECT_EQ(task.X_WHeldStart.p, Vec3(0.0, hand == 0 ? 0.0 : 0.2, 0.1));
        const auto& goal = std::get<simulated::AssembleGoal>(task.goal);
        EXPECT_EQ(goal.hand, hand);
        EXPECT_EQ(goal.close, 4u);
        EXPECT_TRUE(goal.on_press);
        ASSERT_EQ(goal.parts.size(), 3u);
        EXPECT_EQ(goal.parts[1].X_W.p, Vec3(0.1, 0.003, 0.0));
        EXPECT_EQ(goal.parts[1].shown_offset, Vec3(0.0, 0.003, 0.0));
        ASSERT_EQ(goal.steps.size(), 2u);
        EXPECT_EQ(goal.steps[0].part, 1);
        EXPECT_EQ(goal.steps[0].into, 0);
        EXPECT_EQ(goal.steps[0].folds, 0);
        EXPECT_EQ(goal.steps[0].insertion, 0.015);
        EXPECT_EQ(goal.steps[0].hand, 0u);
        EXPECT_EQ(goal.steps[1].into, -1);
        EXPECT_EQ(goal.steps[1].insertion, 0.0);
        EXPECT_EQ(goal.steps[1].after, 1u);
        EXPECT_EQ(goal.steps[1].hand, 1u);
    }
}

TEST(VisibleTask, PartsAreGrippedOnTheirSurfaceNearTheTop) {
    // Truth: closed form. From the axis of a peg at four fifths of its height the side is 5 mm away and the top 8; of
    // the block's middle line at four fifths the top is 2 mm away. The peg's tip is its origin, the block's middle its.
    const plan::Condition condition = assembly();
    const simulated::VisibleTask task = visibleTask(condition);
    const auto& parts = std::get<simulated::AssembleGoal>(task.goal).parts;
    EXPECT_NEAR(parts[1].grip.z(), 0.032, 1e-9);
    EXPECT_NEAR(parts[1].grip.head<2>().norm(), 0.005, 1e-4) << "within what facets are off";
    EXPECT_NEAR(parts[1].below, 0.0, 1e-12);
    EXPECT_NEAR((parts[2].grip - Vec3(0.0, 0.0, 0.005)).norm(), 0.0, 1e-12);
    EXPECT_NEAR(parts[2].below, 0.005, 1e-12);
}

}  // namespace
}  // namespace passung::run
