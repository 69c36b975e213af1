#include "core/tick/passivity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kStiffness = 1000.0;  // [N/m]

/// A ball over a plate whose top is z = 0; its lowest point at `height`.
model::SceneSpec ballOverPlate(double height) {
    model::SceneSpec spec =
        test::scene(model::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.01 + height}}, model::Box{0.06, 0.06, 0.02},
                    Pose{Quat::Identity(), {0, 0, -0.01}}, model::ContactMethod::Penalty);
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = 0.0;
    return spec;
}

/// Lowers the handle by `steps` steps of `step` [m] from where the ball touches and lifts it again; the energy then.
double pressAndRelease(const model::SceneSpec& spec, const Pose& X_BD, int steps, double step) {
    test::Bench bench(spec);
    const Vec3 down = spec.registration.X_WB.q.conjugate() * -Vec3::UnitZ();
    double energy = 0.0;
    for (int k = 0; k <= 2 * steps; ++k) {
        const int deep = k <= steps ? k : 2 * steps - k;
        energy = bench.step(Pose{X_BD.q, X_BD.p + deep * step * down}).frame.energy;
    }
    return energy;
}

TEST(EnergyAccount, OfASampledSpringIsWhatItsHoldGivesOut) {
    // Truth: closed form. Force held from sample to sample: n steps of δ into a spring take in K δ² n (n - 1)/2, and
    // n (n + 1)/2 come out again: -K δ² n. The ball's lowest point is a sample to 0.1 % of the depth here.
    constexpr int n = 20;
    constexpr double step = 1e-4;
    const double expected = -kStiffness * step * step * n;
    const auto spec = ballOverPlate(0.0);
    EXPECT_NEAR(pressAndRelease(spec, spec.parts[0].X_WP, n, step), expected, 0.03 * std::abs(expected));
}

TEST(EnergyAccount, IsThatOfTheDeviceWhateverItsRegistration) {
    // Truth: closed form. As above, the device turned, elsewhere and scaled by s, the part off the handle: -K s δ² n, δ
    // the device's own steps.
    constexpr int n = 20;
    constexpr double step = 1e-4, scale = 2.0;
    auto spec = ballOverPlate(0.0);
    spec.registration.X_WB = {Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), {0.1, -0.2, 0.3}};
    spec.registration.scale = scale;
    spec.registration.X_DH = {Quat(Eigen::AngleAxisd(-0.4, Vec3(0, 1, 1).normalized())), {0.01, 0.02, -0.03}};
    const Pose X_BH = spec.registration.X_WB.inverse() * spec.parts[0].X_WP;
    Pose X_BD = X_BH * spec.registration.X_DH.inverse();
    X_BD.p /= scale;
    const double expected = -kStiffness * scale * step * step * n;
    EXPECT_NEAR(pressAndRelease(spec, X_BD, n, step), expected, 0.03 * std::abs(expected));
}

TEST(EnergyAccount, HeldSamplesBookNothingUntilTheNextAndLostOnesNever) {
    // Truth: closed form. Force F, one move of δ after a held tick: -F δ. After rejected ticks: nothing.
    for (const int bad : {0, 1, 5}) {
        const auto spec = ballOverPlate(-1e-3);
        test::Bench bench(spec);
        DeviceReading reading{spec.parts[0].X_WP};
        for (int i = 0; i < 10; ++i) bench.step(reading);
        const auto pressed = bench.step(reading);
        ASSERT_NEAR(pressed.F_D_B.force.z(), 1.0, 0.03);
        EXPECT_EQ(pressed.frame.energy, 0.0);
        reading.fresh = false;
        for (int i = 0; i < bad; ++i) EXPECT_EQ(bench.step(reading).frame.energy, 0.0);
        reading.fresh = true;
        reading.X_BD.p.z() += 1e-5;
        const double energy = bench.step(reading).frame.energy;
        EXPECT_NEAR(energy, bad > 1 ? 0.0 : -pressed.F_D_B.force.z() * 1e-5, 1e-9);
    }
}

/// The account after a slow press into a spring by `steps` encoder steps `q` and back, `ticks` a step.
double slowPress(double q, double known, int steps, int ticks) {
    auto spec = ballOverPlate(0.0);
    spec.limits.quantum = known;
    test::Bench bench(spec);
    double energy = 0.0;
    for (int k = 0; k <= 2 * steps * ticks; ++k) {
        const double depth = q / ticks * (k <= steps * ticks ? k : 2 * steps * ticks - k);
        Pose X = spec.parts[0].X_WP;
        X.p.z() -= q * std::round(depth / q);
        energy = bench.step(X).frame.energy;
    }
    return energy;
}

TEST(EnergyAccount, TakesNoEncoderStepForEnergyGivenOut) {
    // Truth: closed form. A spring that is read in steps q pushes alike on the way in and on the way out, so that the
    // motors do no work in all; who books whole readings finds -K q² n. A step that comes and goes moves nothing.
    constexpr int n = 20;
    constexpr double q = 64e-6;
    const double whole = -kStiffness * q * q * n;
    EXPECT_NEAR(slowPress(q, 0.0, n, 10), whole, 0.03 * std::abs(whole));
    EXPECT_NEAR(slowPress(q, q, n, 10), 0.0, 1e-3 * std::abs(whole));
    auto spec = ballOverPlate(-1e-3);
    spec.limits.quantum = q;
    test::Bench bench(spec);
    double first = 0.0, last = 0.0;
    for (int k = 0; k < 1000; ++k) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() += k % 2 == 0 ? q : 0.0;
        last = bench.step(X).frame.energy;
        if (k == 2) first = last;
    }
    EXPECT_NEAR(last, first, 1e-3 * std::abs(whole));
}

TEST(EnergyAccount, OfAFastMotionIsOffByLessThanItsBound) {
    // Truth: invariant. Work on the true motion against that on its readings: q times what the force changed by.
    constexpr double q = 64e-6, K = kStiffness;
    auto spec = ballOverPlate(0.0);
    spec.limits.quantum = q;
    test::Bench bench(spec);
    double exact = 0.0, changed = 0.0, force = 0.0, z_before = 0.0;
    for (int k = 0; k < 400; ++k) {
        const double z = -1e-3 * (1.0 - std::cos(0.05 * k));
        exact -= force * (z - z_before);
        z_before = z;
        Pose X = spec.parts[0].X_WP;
        X.p.z() += q * std::round(z / q);
        const auto output = bench.step(X);
        EXPECT_NEAR(output.frame.energy, exact, q * (changed + force) + 1e-9);
        changed += std::abs(output.F_D_B.force.z() - force);
        force = output.F_D_B.force.z();
    }
    EXPECT_GT(changed, K * 4e-3);
}

TEST(PassivityController, TakesBackWhatWasGivenOut) {
    // Truth: closed form. After the cycle above E = -K δ² n; with the handle moving on at v upwards the damper's force
    // is E / (τ v), downwards, and a tick later E is zero again.
    constexpr int n = 20;
    constexpr double step = 1e-4;
    auto spec = ballOverPlate(0.0);
    spec.effects.passivity_damping = 1e6;
    test::Bench bench(spec);
    Pose X = spec.parts[0].X_WP;
    const auto at = [&](int height) {
        Pose here = X;
        here.p.z() += height * step;
        return bench.step(here);
    };
    spec.effects.passivity_damping = 0.0;
    test::Bench without(spec);
    double given = 0.0;
    for (int k = 0; k <= 2 * n; ++k) {
        Pose here = X;
        here.p.z() -= (k <= n ? k : 2 * n - k) * step;
        given = without.step(here).frame.energy;
    }
    ASSERT_LT(given, -1e-4);
    // The controller takes it back on the way, as soon as the account is below zero.
    tick::TickOutput output;
    for (int k = 0; k <= 2 * n; ++k) output = at(-(k <= n ? k : 2 * n - k));
    for (int k = 1; k <= 3; ++k) output = at(k);
    EXPECT_NEAR(output.frame.energy, 0.0, 1e-3 * std::abs(given));
}

TEST(PassivityController, IsNoStageOfASceneWithoutIt) {
    // Truth: invariant. Only the effects that a scene names are built.
    const auto has = [](const model::SceneSpec& spec) {
        test::Bench bench(spec);
        for (const auto& stage : bench.model().stages)
            if (stage.run == tick::runStage<tick::kPassivityController>) return true;
        return false;
    };
    auto spec = ballOverPlate(0.0);
    EXPECT_FALSE(has(spec));
    spec.effects.passivity_damping = 5.0;
    EXPECT_TRUE(has(spec));
}

}  // namespace
}  // namespace passung
