#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

Pose at(double z) { return {Quat::Identity(), Vec3(0, 0, z)}; }

/// A ball over a table; the ball touches at z = 0.01.
model::SceneSpec pressing() {
    auto spec = test::scene(model::Sphere{0.02}, at(0.02), model::Box{0.08, 0.08, 0.04}, at(-0.02),
                            model::ContactMethod::GodObjectHeuristic);
    spec.contact.stiffness = 1000;
    return spec;
}

tick::TickOutput pressed(test::Bench& bench, double depth) {
    tick::TickOutput out;
    for (int i = 0; i < 1000; ++i) out = bench.step(at(0.01 - std::min(depth, 2e-5 * i)));
    return out;
}

TEST(OutputStage, KeepsDirectionAndScalesForceAndTorqueTogether) {
    // Truth: closed form. One factor for both.
    auto spec = pressing();
    spec.registration.X_DH = {Quat::Identity(), Vec3(0.05, 0, 0)};  // a lever: the force makes a torque at the handle
    test::Bench free_bench(spec);
    spec.limits.max_force = 1.5;
    spec.limits.max_torque = 1.0;
    test::Bench limited_bench(spec);
    const auto hand = [](double z) { return Pose{Quat::Identity(), Vec3(-0.05, 0, z)}; };
    tick::TickOutput free_out, limited_out;
    for (int i = 0; i < 1000; ++i) {
        const double z = 0.01 - std::min(0.004, 2e-5 * i);
        free_out = free_bench.step(hand(z));
        limited_out = limited_bench.step(hand(z));
    }
    EXPECT_NEAR(limited_out.F_D_B.force.norm(), 1.5, 1e-12);
    EXPECT_LE(limited_out.F_D_B.force.norm(), 1.5);
    const double factor = limited_out.F_D_B.force.z() / free_out.F_D_B.force.z();
    EXPECT_NEAR(limited_out.F_D_B.torque.y(), factor * free_out.F_D_B.torque.y(), 1e-12);
    // About the handle, the force at the held part's origin adds its lever.
    EXPECT_NEAR(free_out.F_D_B.torque.y(), free_out.frame.F_H_W.torque.y() - 0.05 * free_out.frame.F_H_W.force.z(),
                1e-9);
    EXPECT_TRUE(limited_out.frame.status & kForceLimited);
    EXPECT_FALSE(free_out.frame.status & kForceLimited);
}

TEST(OutputStage, LimitsTheRiseOfForceButNotItsFall) {
    // Truth: closed form. Rising by at most rate · T a tick; zero at once when the hand leaves.
    auto spec = pressing();
    spec.contact.damping = 0;
    spec.limits.max_force_rate = 500;  // 0.5 N a tick
    test::Bench bench(spec);
    bench.step(at(0.0105));
    double last = 0;
    for (int i = 0; i < 5; ++i) {
        const auto out = bench.step(at(0.006));  // 4 N asked for
        EXPECT_NEAR(out.F_D_B.force.norm(), last + 0.5, 1e-9);
        EXPECT_TRUE(out.frame.status & kRateLimited);
        last = out.F_D_B.force.norm();
    }
    for (int i = 0; i < 20; ++i) bench.step(at(0.006));
    const auto out = bench.step(at(0.0105));
    EXPECT_EQ(out.F_D_B.force.norm(), 0.0);
    EXPECT_FALSE(out.frame.status & kRateLimited);
}

TEST(OutputStage, HoldsThePoseForOneBadSampleThenGivesZero) {
    // Truth: invariant (the output stage's contract), for each kind of bad sample.
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    DeviceReading stale{at(0.006)};
    stale.fresh = false;
    for (const DeviceReading& bad : {DeviceReading{at(nan)}, DeviceReading{at(inf)}, DeviceReading{at(1.0)}, stale,
                                     DeviceReading{Pose{Quat(0, 0, 0, 0), Vec3(0, 0, 0.006)}}}) {
        test::Bench bench(pressing());
        const auto before = pressed(bench, 0.004);
        const auto held = bench.step(bad);
        EXPECT_NEAR(held.F_D_B.force.z(), before.F_D_B.force.z(), 1e-6);
        EXPECT_TRUE(held.frame.status & kInputHeld);
        const auto after = bench.step(at(0.006));
        EXPECT_NEAR(after.F_D_B.force.z(), before.F_D_B.force.z(), 0.05 * before.F_D_B.force.z());
        EXPECT_FALSE(after.frame.status & (kInputHeld | kRateLimited));
        bench.step(bad);
        for (int i = 0; i < 3; ++i) {
            const auto zero = bench.step(bad);
            EXPECT_EQ(zero.F_D_B.force.norm(), 0.0);
            EXPECT_TRUE(zero.frame.status & kInputRejected);
        }
    }
}

TEST(OutputStage, IsFiniteAndWithinLimitsUnderHostileInput) {
    // Truth: invariant. 20 000 ticks of random poses, jumps, NaN and infinity.
    for (const auto method : {model::ContactMethod::Penalty, model::ContactMethod::GodObjectHeuristic}) {
        auto spec = pressing();
        spec.contact.method = method;
        spec.limits.max_force = 3;
        spec.limits.max_torque = 0.1;
        test::Bench bench(spec);
        Random random(9);
        for (int i = 0; i < 20000; ++i) {
            DeviceReading reading{at(random.uniform(-0.02, 0.02))};
            reading.X_BD.q = rotationFromVector(Vec3(random.normal(), random.normal(), random.normal()));
            if (random.below(20) == 0) reading.X_BD.p.x() = std::numeric_limits<double>::quiet_NaN();
            if (random.below(20) == 0) reading.X_BD.q.w() = std::numeric_limits<double>::infinity();
            if (random.below(20) == 0) reading.X_BD.p.y() = 1e300;
            reading.fresh = random.below(20) != 0;
            const auto out = bench.step(reading);
            ASSERT_TRUE(isFinite(out.F_D_B));
            ASSERT_TRUE(isFinite(out.X_WG));
            ASSERT_TRUE(isFinite(out.frame.X_WH));
            ASSERT_LE(out.F_D_B.force.norm(), 3.0);
            ASSERT_LE(out.F_D_B.torque.norm(), 0.1);
        }
    }
}

TEST(OutputStage, LatchesZeroAfterANonFiniteWrenchUntilTheStateIsMadeAnew) {
    // Truth: invariant. A stage that computes NaN is planted for one tick.
    test::Bench bench(pressing());
    pressed(bench, 0.004);
    tick::TickModel broken = bench.model();
    broken.stages.insert(
        broken.stages.end() - 1,
        {"broken", "planted", true, [](const tick::TickModel&, tick::TickState&, tick::TickFrame& f) noexcept {
             f.F_H_W.force.x() = std::numeric_limits<double>::quiet_NaN();
         }});
    const auto bad = tick::step(broken, bench.state(), DeviceReading{at(0.006)});
    EXPECT_EQ(bad.F_D_B.force.norm(), 0.0);
    EXPECT_TRUE(bad.frame.status & kNonFiniteLatched);
    const auto still = bench.step(at(0.006));
    EXPECT_EQ(still.F_D_B.force.norm(), 0.0);
    EXPECT_TRUE(still.frame.status & kNonFiniteLatched);
    bench.state() = tick::makeState(bench.model());
    EXPECT_GT(pressed(bench, 0.004).F_D_B.force.norm(), 3.0);
}

TEST(OutputStage, RendersNoTorqueOnADeviceThatHasNone) {
    // Truth: invariant.
    auto spec = pressing();
    spec.registration.X_DH = {Quat::Identity(), Vec3(0.05, 0, 0)};
    spec.limits.actuates_torque = false;
    spec.limits.max_torque = 0;
    test::Bench bench(spec);
    tick::TickOutput out;
    for (int i = 0; i < 1000; ++i)
        out = bench.step(Pose{Quat::Identity(), Vec3(-0.05, 0, 0.01 - std::min(0.004, 2e-5 * i))});
    EXPECT_NEAR(out.F_D_B.force.z(), 4.0, 0.05);
    EXPECT_EQ(out.F_D_B.torque.norm(), 0.0);
}

TEST(OutputStage, DelaysTheWrenchByTheTicksThatTheSceneNames) {
    // Truth: invariant. The same motion with and without delay gives the same wrenches, shifted.
    auto spec = pressing();
    test::Bench prompt(spec);
    spec.limits.delay_ticks = 3;
    test::Bench delayed(spec);
    std::vector<double> asked, given;
    for (int i = 0; i < 300; ++i) {
        const double z = 0.01 - 2e-5 * i;
        asked.push_back(prompt.step(at(z)).F_D_B.force.z());
        given.push_back(delayed.step(at(z)).F_D_B.force.z());
    }
    for (std::size_t i = 3; i < asked.size(); ++i) EXPECT_EQ(given[i], asked[i - 3]);
}

}  // namespace
}  // namespace passung
