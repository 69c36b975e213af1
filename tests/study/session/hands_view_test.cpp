#include "study/session/hands_view.h"

#include <gtest/gtest.h>

#include <array>

#include "core/base/random.h"

namespace passung::session {
namespace {

/// A peg in the first hand; its target in the second one, or at rest.
plan::Condition pegCondition(bool target_held) {
    plan::Condition condition;
    condition.task.form = plan::PegInHoleTask{};
    condition.task.target = "plate";
    condition.scene.parts.push_back({.name = "peg", .geometry = shape::Sphere{0.01}, .X_WP = {}, .held = true});
    condition.scene.parts.push_back({.name = "plate",
                                     .geometry = shape::Sphere{0.01},
                                     .X_WP = {rotationFromVector({0.1, 0.2, -0.3}), Vec3(0.01, 0.02, 0.03)},
                                     .held = target_held,
                                     .hand = target_held ? std::size_t{1} : std::size_t{0}});
    condition.scene.parts.push_back(
        {.name = "tool", .geometry = shape::Sphere{0.01}, .X_WP = {}, .held = true, .hand = target_held ? 2u : 1u});
    condition.scene.other_hands.resize(target_held ? 2 : 1);
    return condition;
}

Vec3 vectorOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
Quat rotationOf(const std::array<float, 4>& q) { return Quat(q[0], q[1], q[2], q[3]).normalized(); }

void store(std::array<float, 3>& into, const Vec3& v) {
    for (std::size_t i = 0; i < 3; ++i) into[i] = static_cast<float>(v[static_cast<int>(i)]);
}

TickRecord recordAt(std::int64_t tick, const Pose& X_W, bool engaged = true) {
    TickRecord record;
    record.tick = tick;
    store(record.proxy_position_m, X_W.p);
    store(record.hand_position_m, X_W.p);
    record.proxy_quaternion = {static_cast<float>(X_W.q.w()), static_cast<float>(X_W.q.x()),
                               static_cast<float>(X_W.q.y()), static_cast<float>(X_W.q.z())};
    record.hand_quaternion = record.proxy_quaternion;
    record.status = engaged ? kEngaged : 0u;
    return record;
}

Pose randomPose(Random& random) {
    const auto draw = [&] { return random.uniform(-1.0, 1.0); };
    const double a = draw(), b = draw(), c = draw(), x = draw(), y = draw(), z = draw();
    return {rotationFromVector(Vec3(a, b, c)), 0.1 * Vec3(x, y, z)};
}

TEST(HandsView, SeesTheHeldPartFromATargetThatMoves) {
    // Truth: definition. The peg's pose in the target's frame is the same before and after, with the target moved back
    // to where it starts; lengths of force and torque stay, and their directions in the target's frame.
    const plan::Condition condition = pegCondition(true);
    const Pose X_WT_start = condition.scene.parts[1].X_WP;
    const HandsView view(condition);
    ASSERT_EQ(view.otherHands(), 2u);
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const Pose X_WG = randomPose(random), X_WT = randomPose(random);
        TickRecord peg = recordAt(7, X_WG);
        store(peg.force_N, 3.0 * randomPose(random).p);
        store(peg.torque_Nm, randomPose(random).p);
        const std::array others{std::vector{recordAt(6, randomPose(random)), recordAt(7, X_WT)},
                                std::vector{recordAt(7, randomPose(random))}};
        const TickRecord seen = view.of(peg, others);
        const Pose X_TG = X_WT.inverse() * X_WG;
        const Pose then =
            X_WT_start.inverse() * Pose{rotationOf(seen.proxy_quaternion), vectorOf(seen.proxy_position_m)};
        EXPECT_LT((then.p - X_TG.p).norm(), 1e-7);
        EXPECT_LT(then.q.angularDistance(X_TG.q), 1e-6);
        EXPECT_EQ(seen.hand_position_m, seen.proxy_position_m);
        const Vec3 force_T = X_WT.q.conjugate() * vectorOf(peg.force_N);
        EXPECT_LT((X_WT_start.q.conjugate() * vectorOf(seen.force_N) - force_T).norm(), 1e-6);
        EXPECT_NEAR(vectorOf(seen.torque_Nm).norm(), vectorOf(peg.torque_Nm).norm(), 1e-6);
        EXPECT_EQ(seen.status, peg.status);
    }
}

TEST(HandsView, ATargetAtRestChangesNoBit) {
    // Truth: invariant, however the other hand moves.
    const HandsView view(pegCondition(false));
    Random random(6);
    const TickRecord peg = recordAt(3, randomPose(random));
    const TickRecord seen = view.of(peg, std::array{std::vector{recordAt(3, randomPose(random))}});
    EXPECT_EQ(seen.proxy_position_m, peg.proxy_position_m);
    EXPECT_EQ(seen.proxy_quaternion, peg.proxy_quaternion);
    EXPECT_EQ(seen.status, peg.status);
}

TEST(HandsView, IsEngagedOnceAllHandsAre) {
    // Truth: table of truth. A tick that was not recorded of another hand is as the one before it.
    const HandsView view(pegCondition(false));
    const auto engaged = [&](bool first, const std::vector<TickRecord>& other) {
        return (view.of(recordAt(3, {}, first), std::array{other}).status & kEngaged) != 0;
    };
    EXPECT_TRUE(engaged(true, {recordAt(3, {}, true)}));
    EXPECT_FALSE(engaged(true, {recordAt(3, {}, false)}));
    EXPECT_FALSE(engaged(false, {recordAt(3, {}, true)}));
    EXPECT_FALSE(engaged(true, {}));
    EXPECT_TRUE(engaged(true, {recordAt(2, {}, true), recordAt(4, {}, false)}));
    EXPECT_FALSE(engaged(true, {recordAt(4, {}, true)}));
}

TEST(HandsView, OfOneHandTheRecordIsWhatItIs) {
    // Truth: invariant.
    plan::Condition condition = pegCondition(false);
    condition.scene.parts.pop_back();
    condition.scene.other_hands.clear();
    const HandsView view(condition);
    EXPECT_EQ(view.otherHands(), 0u);
    Random random(7);
    const TickRecord peg = recordAt(3, randomPose(random));
    EXPECT_EQ(view.of(peg, {}).proxy_quaternion, peg.proxy_quaternion);
}

}  // namespace
}  // namespace passung::session
