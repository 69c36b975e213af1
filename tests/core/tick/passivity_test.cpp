#include "core/tick/passivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/tick/hand_state.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kStiffness = 1000.0;  // [N/m]

/// A ball over a plate whose top is z = 0; its lowest point at `height`.
scene::SceneSpec ballOverPlate(double height) {
    scene::SceneSpec spec =
        test::scene(shape::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.01 + height}}, shape::Box{0.06, 0.06, 0.02},
                    Pose{Quat::Identity(), {0, 0, -0.01}}, scene::ContactMethod::Penalty);
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = 0.0;
    return spec;
}

/// Lowers the handle by `steps` steps of `step` [m] from where the ball touches and lifts it again; the energy then.
double pressAndRelease(const scene::SceneSpec& spec, const Pose& X_BD, int steps, double step) {
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

TEST(EnergyAccount, BooksForcesAndTorquesOnTheMotionThatIsCertain) {
    // Truth: the header's equations, by the readings themselves and not their steps: y, the place nearest to the one
    // before within half an encoder step of each reading, in every coordinate; E -= F̄ · Δy + T̄ · Δψ with the means of
    // what was sent since the good sample before. Rotation about one axis, where turns add up. Fast and slow handles,
    // held and rejected ticks, two pairs that are booked likewise; the velocity is that of the readings.
    Random random(31);
    for (int run = 0; run < 40; ++run) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        const auto anyWrench = [&] { return Wrench{any(), 0.1 * any()}; };
        tick::HandModel model;
        model.limits.quantum = run % 4 == 0 ? 0.0 : 1e-4;
        model.limits.rotational_quantum = run % 3 == 0 ? 0.0 : 2e-3;
        const Vec3 q = Vec3::Constant(0.5 * model.limits.quantum),
                   r = Vec3::Constant(0.5 * model.limits.rotational_quantum);
        const double speed = run % 2 == 0 ? 2e-4 : 2e-5;
        const Vec3 axis = any().normalized();
        tick::HandState state;
        state.pairs.resize(2);
        state.last_shares.resize(2);
        Vec3 x = any(), x_before = x, y = x, psi = Vec3::Zero();
        double angle = 0.3, angle_before = angle;
        bool known = false;
        int ticks = 0;
        std::array<Wrench, 3> sum{};  // the whole, and of each pair
        std::array<double, 3> energy{};
        for (int i = 0; i < 300; ++i) {
            state.last_sent = anyWrench();
            for (std::size_t k = 0; k < 2; ++k) state.last_shares[k] = anyWrench();
            const Wrench sent[] = {state.last_sent, state.last_shares[0], state.last_shares[1]};
            for (std::size_t k = 0; k < 3; ++k) {
                sum[k].force += sent[k].force;
                sum[k].torque += sent[k].torque;
            }
            ++ticks;
            tick::TickFrame frame;
            const auto kind = random.below(12);
            frame.input_usable = kind != 0;
            frame.sample_periods = kind < 3 ? 0 : ticks + static_cast<int>(random.below(3));
            if (kind >= 3) {
                x += speed * any();
                angle += 20.0 * speed * random.normal();
            }
            state.X_BD_good = {rotationFromVector(angle * axis), x};
            tick::runStage<tick::kEnergyAccount>(model, state, frame);
            if (kind == 0) {
                known = false;
            } else if (kind >= 3) {
                if (known) {
                    const Vec3 y_now = y.cwiseMin(x + q).cwiseMax(x - q), turn = angle * axis;
                    const Vec3 psi_now = psi.cwiseMin(turn + r).cwiseMax(turn - r);
                    for (std::size_t k = 0; k < 3; ++k)
                        energy[k] -= (sum[k].force.dot(y_now - y) + sum[k].torque.dot(psi_now - psi)) / ticks;
                    y = y_now;
                    psi = psi_now;
                    const double elapsed = 1e-3 * static_cast<double>(frame.sample_periods);
                    EXPECT_NEAR((state.energy.V_BD.v - (x - x_before) / elapsed).norm(), 0.0, 1e-9);
                    EXPECT_NEAR((state.energy.V_BD.w - (angle - angle_before) / elapsed * axis).norm(), 0.0, 1e-9);
                } else {
                    y = x;
                    psi = angle * axis;
                    EXPECT_EQ(state.energy.V_BD.v.norm() + state.energy.V_BD.w.norm(), 0.0) << "not known yet";
                }
                x_before = x;
                angle_before = angle;
                known = true;
                ticks = 0;
                sum = {};
            }
            ASSERT_NEAR(frame.energy, energy[0], 1e-12) << i;
            ASSERT_NEAR(state.pairs[0].taken_in, energy[1], 1e-12) << i;
            ASSERT_NEAR(state.pairs[1].taken_in, energy[2], 1e-12) << i;
        }
    }
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

/// The damper alone, on an account that is `energy` [J] below zero, at a handle that moves with V_BD.
class Damper {
public:
    static constexpr double kRadius = 0.03;  // ρ [m]

    Damper() {
        model.metric_radius = kRadius;
        model.registration.X_WB = {rotationFromVector(Vec3(0.3, -0.8, 0.5)), Vec3(1, 2, 3)};
        model.registration.X_DH = {rotationFromVector(Vec3(-0.4, 0.2, 0.9)), Vec3(0.05, -0.02, 0.03)};
    }
    /// On the held part, beside what the contact asks for.
    Wrench damp(double energy, const Twist& V_BD, double most, std::int64_t sample_periods = 1) {
        model.effects.passivity_damping = most;
        tick::TickFrame frame;
        frame.X_WH = X_WH;
        frame.F_H_W = kContact;
        frame.sample_periods = sample_periods;
        tick::HandState state;
        state.X_DG = model.registration.X_DH;
        state.energy.taken_in = energy;
        state.energy.V_BD = V_BD;
        tick::runStage<tick::kPassivityController>(model, state, frame);
        acted = (frame.status & kPassivityActed) != 0;
        return {frame.F_H_W.force - kContact.force, frame.F_H_W.torque - kContact.torque};
    }
    /// Of the held part's origin, world axes, where the handle's is V_BD.
    Twist ofHeldPart(const Twist& V_BD) const {
        const Quat& R_WB = model.registration.X_WB.q;
        const Vec3 lever = X_WH.p - (X_WH * model.registration.X_DH.inverse()).p;
        const Vec3 w = R_WB * V_BD.w;
        return {R_WB * V_BD.v + w.cross(lever), w};
    }

    tick::HandModel model;
    Pose X_WH{rotationFromVector(Vec3(0.7, 0.1, -0.4)), Vec3(0.2, -0.1, 0.4)};
    bool acted = false;

private:
    const Wrench kContact{Vec3(1, -2, 3), Vec3(0.01, 0.02, -0.03)};
};

TEST(PassivityController, DampsMotionAndRotationSoThatOneTickTakesBackWhatWasGivenOut) {
    // Truth: closed form. In a tick of a handle that goes on the damper's work is E, half of it where the damping may
    // be half of what that takes; its force is -α v, its torque -α ρ² ω about the handle, base axes. Handles that move,
    // turn, and do both.
    Damper damper;
    Random random(8);
    constexpr double rho2 = Damper::kRadius * Damper::kRadius;
    for (int trial = 0; trial < 200; ++trial) {
        const auto any = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
        const Twist V{trial % 3 == 1 ? Vec3(Vec3::Zero()) : Vec3(0.1 * any()),
                      trial % 3 == 2 ? Vec3(Vec3::Zero()) : Vec3(3.0 * any())};
        const double square = V.v.squaredNorm() + rho2 * V.w.squaredNorm(), energy = -random.uniform(1e-6, 1e-3);
        const double enough = -energy / (kTickSeconds * square);
        for (const double most : {2.0 * enough, 0.5 * enough}) {
            const double alpha = std::min(enough, most);
            const Wrench F = damper.damp(energy, V, most);
            const Twist V_H = damper.ofHeldPart(V);
            EXPECT_TRUE(damper.acted);
            EXPECT_NEAR(kTickSeconds * (F.force.dot(V_H.v) + F.torque.dot(V_H.w)),
                        most > enough ? energy : 0.5 * energy, -1e-9 * energy);
            const Quat R_BW = damper.model.registration.X_WB.q.conjugate();
            const Vec3 lever = damper.X_WH.p - (damper.X_WH * damper.model.registration.X_DH.inverse()).p;
            const Vec3 torque = R_BW * (F.torque + lever.cross(F.force));
            EXPECT_NEAR((R_BW * F.force + alpha * V.v).norm(), 0.0, 1e-9 * alpha * std::sqrt(square));
            EXPECT_NEAR((torque + alpha * rho2 * V.w).norm(), 0.0, 1e-9 * alpha * std::sqrt(square));
        }
    }
}

TEST(PassivityController, DoesNothingWhereNothingIsOwedOrNothingIsKnown) {
    // Truth: limit cases. An account at or above zero, a handle at rest, a held tick.
    Damper damper;
    const Twist V{Vec3(0.1, 0, 0), Vec3(0, 1, 0)};
    const auto isNothing = [&](const Wrench& F) {
        return !damper.acted && F.force.norm() == 0.0 && F.torque.norm() == 0.0;
    };
    EXPECT_TRUE(isNothing(damper.damp(0.0, V, 10.0)));
    EXPECT_TRUE(isNothing(damper.damp(1e-4, V, 10.0)));
    EXPECT_TRUE(isNothing(damper.damp(-1e-4, Twist{}, 10.0)));
    EXPECT_TRUE(isNothing(damper.damp(-1e-4, V, 10.0, 0)));
    EXPECT_FALSE(isNothing(damper.damp(-1e-4, V, 10.0, 2)));
}

TEST(PassivityController, IsNoStageOfASceneWithoutIt) {
    // Truth: invariant. Only the effects that a scene names are built.
    const auto has = [](const scene::SceneSpec& spec) {
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
