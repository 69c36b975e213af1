#include "core/tick/viscosity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kDamping = 4.0, kTurning = 0.02;  // [N·s/m], [N·m·s/rad]

/// A ball in the air, nothing else.
scene::SceneSpec ballInFluid() {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.02}, Pose{}, shape::Box{0.06, 0.06, 0.02},
                                        Pose{Quat::Identity(), {0, 0, -1}}, scene::ContactMethod::GodObject);
    spec.parts.resize(1);
    spec.effects.viscosity = {kDamping, kTurning};
    spec.effects.record = true;
    return spec;
}

TEST(Viscosity, OfASteadyMotionIsDampingTimesSpeed) {
    // Truth: closed form: F = -b v (1 - exp(-t/tau)) of a speed that begins at once, T = -b w likewise.
    test::Bench bench(ballInFluid());
    const Vec3 v(0.05, -0.02, 0.1), w(0.3, 0.6, -0.2);
    for (int i = 0; i < 60; ++i) {
        const double t = kTickSeconds * i;
        const auto out = bench.step(Pose{rotationFromVector(t * w), t * v});
        const double grown = 1.0 - std::exp(-t / tick::kStirringTime);
        EXPECT_LT((out.frame.F_H_W.force + kDamping * grown * v).norm(), 1e-12) << i;
        EXPECT_LT((out.frame.F_H_W.torque + kTurning * grown * w).norm(), 1e-9) << i;
        EXPECT_EQ(out.frame.of_viscosity.force, out.frame.F_H_W.force);
    }
}

TEST(Viscosity, OfASlowSwingTakesEnergyInAndIsWithinOnePerCent) {
    // Truth: closed form: x = a sin(2 pi f t) takes b (2 pi f a)²/2 in a second.
    test::Bench bench(ballInFluid());
    constexpr double kAmplitude = 0.02, kHertz = 2.0, kSeconds = 5.0;
    double energy = 0.0;
    for (int i = 0; i <= static_cast<int>(kSeconds / kTickSeconds); ++i) {
        const double phase = 2.0 * std::numbers::pi * kHertz * kTickSeconds * i;
        energy = bench.step(Pose{Quat::Identity(), Vec3(kAmplitude * std::sin(phase), 0, 0)}).frame.energy;
    }
    const double speed = 2.0 * std::numbers::pi * kHertz * kAmplitude;
    EXPECT_NEAR(energy / (0.5 * kDamping * speed * speed * kSeconds), 1.0, 0.01);
}

TEST(Viscosity, KeepsWhatItHadOverAHeldSampleAndForgetsItAfterLostOnes) {
    // Truth: invariant: nothing is known of a motion that was not sampled.
    test::Bench bench(ballInFluid());
    const auto at = [](int tick) { return DeviceReading{{Quat::Identity(), Vec3(1e-4 * tick, 0, 0)}}; };
    tick::TickOutput out;
    for (int i = 0; i < 40; ++i) out = bench.step(at(i));
    const Vec3 steady = out.frame.of_viscosity.force;
    DeviceReading held = at(40);
    held.fresh = false;
    EXPECT_EQ(bench.step(held).frame.of_viscosity.force, steady);
    EXPECT_LT((bench.step(at(41)).frame.of_viscosity.force - steady).norm(), 1e-5 * steady.norm())
        << "two periods later, as fast";
    DeviceReading lost = at(42);
    lost.X_BD.p.x() = std::nan("");
    for (int i = 0; i < 5; ++i) out = bench.step(lost);
    EXPECT_EQ(out.frame.of_viscosity.force, Vec3::Zero());
    EXPECT_EQ(bench.step(at(47)).frame.of_viscosity.force, Vec3::Zero()) << "the first sample again";
}

TEST(Viscosity, IsNotThereWithoutDamping) {
    // Truth: invariant: no stage, the same bits as a scene that does not name it.
    auto spec = ballInFluid();
    spec.effects.viscosity = {};
    test::Bench without(spec);
    for (const tick::Stage& stage : without.model().stages) {
        EXPECT_STRNE(stage.name, "viscosity");
        EXPECT_STRNE(stage.name, "sum of effects");
    }
    EXPECT_EQ(without.step(Pose{}).frame.effects, 0u);
}

}  // namespace
}  // namespace passung
