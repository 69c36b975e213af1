#include "devices/simulated/device_dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/tick_record.h"
#include "core/loop/stability.h"

using namespace passung;
using namespace passung::simulated;

namespace {

/// Without dry friction and encoder steps, so that closed forms hold.
DeviceParams smoothDevice() {
    DeviceParams p = *findPreset("sigma7");
    p.coulomb_force.value = p.coulomb_torque.value = 0;
    p.quantum.value = p.rotational_quantum.value = 0;
    p.workspace_radius.value = 10;  // no end stop near
    return p;
}

const HandCoupling kNobody{};

TEST(DeviceDynamics, FreeMotionDecaysExponentially) {
    // Truth: closed form, v = v0 exp(-b t/m), x = v0 m/b (1 - exp(-b t/m)); rotation alike about a fixed axis.
    DeviceParams p = smoothDevice();
    p.rotational_damping.value = 2e-3;
    DeviceDynamics device(p, {});
    device.place({}, {Vec3(0.1, 0, 0), Vec3(0, 0, 0.5)});
    for (int k = 0; k < 700; ++k) device.advance(kNobody);
    const double decay = std::exp(-p.damping.value * 0.7 / p.mass.value);
    EXPECT_NEAR(device.trueTwist().v.x(), 0.1 * decay, 1e-6 * 0.1);
    EXPECT_NEAR(device.truePose().p.x(), 0.1 * p.mass.value / p.damping.value * (1 - decay), 1e-7);
    const double rate = p.rotational_damping.value / p.inertia.value;
    const double turn = 0.5 / rate * (1 - std::exp(-rate * 0.7));
    EXPECT_NEAR(rotationVector(device.truePose().q).z(), turn, 1e-5 * turn);
}

TEST(DeviceDynamics, ConstantForceAcceleratesExactly) {
    // Truth: closed form, x = F t²/(2 m) without damping.
    DeviceParams p = smoothDevice();
    p.damping.value = 0;
    DeviceDynamics device(p, {});
    for (int k = 0; k < 100; ++k) {
        device.command({Vec3(0, 2, 0), Vec3::Zero()});
        device.advance(kNobody);
    }
    EXPECT_NEAR(device.truePose().p.y(), 2 * 0.1 * 0.1 / (2 * p.mass.value), 1e-12);
}

TEST(DeviceDynamics, DryFrictionStopsAtTheClosedFormDistance) {
    // Truth: closed form, a body under friction alone stops after v² m/(2 f_c), then rests exactly.
    DeviceParams p = smoothDevice();
    p.damping.value = 0;
    p.coulomb_force.value = 0.1;
    DeviceDynamics device(p, {});
    device.place({}, {Vec3(0, 0, 0.05), Vec3::Zero()});
    for (int k = 0; k < 1000; ++k) device.advance(kNobody);
    const double way = 0.05 * 0.05 * p.mass.value / (2 * 0.1);
    // Friction acts at the end of each substep, so the way is long by up to v h/2 = 6 µm.
    EXPECT_NEAR(device.truePose().p.z(), way, 7e-6);
    EXPECT_EQ(device.trueTwist().v, Vec3(0, 0, 0));
}

TEST(DeviceDynamics, DryFrictionHoldsWithoutCreep) {
    // Truth: invariant; below f_c nothing moves at all, above it does.
    DeviceParams p = smoothDevice();
    p.coulomb_force.value = 0.1;
    p.coulomb_torque.value = 1e-3;
    DeviceDynamics device(p, {});
    for (int k = 0; k < 5000; ++k) {
        device.command({Vec3(0.099, 0, 0), Vec3(0, 0.99e-3, 0)});
        device.advance(kNobody);
    }
    EXPECT_EQ(device.truePose().p, Vec3(0, 0, 0));
    EXPECT_EQ(device.truePose().q.coeffs(), Quat::Identity().coeffs());
    for (int k = 0; k < 100; ++k) {
        device.command({Vec3(0.101, 0, 0), Vec3::Zero()});
        device.advance(kNobody);
    }
    EXPECT_GT(device.truePose().p.x(), 0);
}

TEST(DeviceDynamics, HeldHandleNeverGainsEnergy) {
    // Truth: invariant; kinetic energy and the energy of the hand's spring never rise while the set-point rests.
    DeviceParams p = smoothDevice();
    p.coulomb_force.value = 0.3;
    DeviceDynamics device(p, {});
    HandCoupling hand;
    hand.attached = true;
    hand.mass = 0.5;
    hand.inertia = 1e-3;
    hand.stiffness = 500;
    hand.rotational_stiffness = 3;
    hand.X_BSet.p = Vec3(0.02, -0.01, 0.005);
    device.place({}, {Vec3(-0.3, 0.2, 0.1), Vec3::Zero()});
    double last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3000; ++k) {
        const double energy = 0.5 * (p.mass.value + hand.mass) * device.trueTwist().v.squaredNorm() +
                              0.5 * hand.stiffness * (hand.X_BSet.p - device.truePose().p).squaredNorm();
        EXPECT_LE(energy, last * (1 + 1e-12)) << k;
        last = energy;
        device.advance(hand);
    }
    // At rest no farther from the set-point than friction can hold.
    EXPECT_EQ(device.trueTwist().v, Vec3(0, 0, 0));
    EXPECT_LE(hand.stiffness * (hand.X_BSet.p - device.truePose().p).norm(), 0.3);
}

TEST(DeviceDynamics, TheEndStopEndsTheWorkspace) {
    // Truth: closed form: where a set-point far outside pulls with k_h, the handle comes to rest where the stop of k_s
    // balances it, k_s x = k_h (d - x) beyond the border; and it is not passed by more than a hand of 1 m/s is stopped
    // in, v sqrt((m + m_h)/k_s). Every preset has its own border.
    for (const DeviceParams& preset : presets()) {
        DeviceDynamics device(preset, {});
        HandCoupling hand;
        hand.attached = true;
        hand.mass = 0.5;
        hand.damping = 8;
        hand.stiffness = 300;
        const double radius = preset.workspace_radius.value, beyond = 0.1;
        hand.X_BSet.p = (radius + beyond) * Vec3(1, -2, 2) / 3;
        double farthest = 0.0, fastest = 0.0;
        for (int k = 0; k < 6000; ++k) {
            device.advance(hand);
            farthest = std::max(farthest, device.truePose().p.norm());
            fastest = std::max(fastest, device.trueTwist().v.norm());
        }
        const double rest = 300 * beyond / (20000 + 300), friction = preset.coulomb_force.value / 20300;
        EXPECT_NEAR(device.truePose().p.norm(), radius + rest, friction + 1e-5) << preset.name;
        EXPECT_LT(farthest, radius + rest + fastest * std::sqrt((preset.mass.value + 0.5) / 20000)) << preset.name;
        EXPECT_GE(device.handEnergy(), 0.0) << preset.name;
    }
}

TEST(DeviceDynamics, InsideTheWorkspaceNoBitKnowsOfTheEndStop) {
    // Truth: invariant: a device that is larger moves the same, as long as the handle stays inside.
    DeviceParams large = *findPreset("falcon");
    large.workspace_radius.value = 1.0;
    DeviceDynamics one(*findPreset("falcon"), {}), other(large, {});
    HandCoupling hand;
    hand.attached = true;
    hand.mass = 0.5;
    hand.damping = 8;
    hand.stiffness = 300;
    for (int k = 0; k < 4000; ++k) {
        hand.X_BSet.p = 0.012 * Vec3(std::sin(0.004 * k), std::cos(0.003 * k) - 1.0, 0.3);
        one.command({Vec3(std::sin(0.1 * k), 0, -0.0), Vec3::Zero()});
        other.command({Vec3(std::sin(0.1 * k), 0, -0.0), Vec3::Zero()});
        one.advance(hand);
        other.advance(hand);
        ASSERT_LT(one.truePose().p.norm(), 0.04);
        ASSERT_EQ(one.truePose().p, other.truePose().p) << k;
        ASSERT_EQ(one.handEnergy(), other.handEnergy()) << k;
    }
}

TEST(DeviceDynamics, AccountsForWhatTheHandPutsIn) {
    // Truth: closed form. A hand of mass m_h pushes with F for t: the handle gets m_d v²/2, v = F t/(m_d + m_h), and
    // not what stays in the hand. With dry friction f on the way x: f x more (F - f accelerates). With motors that give
    // M: M x less. Turning alike.
    constexpr double F = 2.0, kTime = 0.2, kHandMass = 0.3;
    const auto push = [&](double friction, double motors) {
        DeviceParams p = smoothDevice();
        p.damping.value = p.rotational_damping.value = 0;
        p.coulomb_force.value = friction;
        DeviceDynamics device(p, {});
        HandCoupling hand;
        hand.attached = true;
        hand.mass = kHandMass;
        hand.F_D_B.force.x() = F;
        for (int k = 0; k < 200; ++k) {
            device.command({Vec3(motors, 0, 0), Vec3::Zero()});
            device.advance(hand);
        }
        const double v = (F + motors - friction) / (p.mass.value + kHandMass) * kTime;
        EXPECT_NEAR(device.trueTwist().v.x(), v, 1e-9);
        const double way = device.truePose().p.x();
        // Friction acts at the end of a substep h, on a speed that is higher by what it takes: f h v/2 more in all.
        const double expected =
            0.5 * p.mass.value * v * v + friction * (way + 0.5 * kTickSeconds / 4 * v) - motors * way;
        EXPECT_NEAR(device.handEnergy(), expected, 1e-12) << friction << ' ' << motors;
    };
    push(0.0, 0.0);
    push(0.5, 0.0);
    push(0.0, 1.0);
    push(0.5, -1.0);

    DeviceParams p = smoothDevice();
    p.rotational_damping.value = 0;
    DeviceDynamics device(p, {});
    HandCoupling hand;
    hand.attached = true;
    hand.inertia = 1e-3;
    hand.F_D_B.torque.z() = 1e-3;
    for (int k = 0; k < 200; ++k) device.advance(hand);
    const double w = 1e-3 / (p.inertia.value + hand.inertia) * kTime;
    EXPECT_NEAR(device.handEnergy(), 0.5 * p.inertia.value * w * w, 1e-12);
}

TEST(DeviceDynamics, GivesTheHandBackOnlyWhatItHadFromIt) {
    // Truth: invariant. Without motors the handle is passive: its account at the hand's port is never below zero.
    DeviceDynamics device(*findPreset("virtuose6d"), {});
    HandCoupling hand;
    hand.attached = true;
    hand.mass = 0.5;
    hand.stiffness = 300;
    hand.damping = 15;
    double most = 0.0;
    for (int k = 0; k < 5000; ++k) {
        hand.X_BSet.p = 0.05 * Vec3(std::sin(0.011 * k), std::sin(0.017 * k), std::sin(0.023 * k * k / 5000));
        device.advance(hand);
        ASSERT_GE(device.handEnergy(), 0.0) << k;
        most = std::max(most, device.handEnergy());
    }
    EXPECT_GT(most, 0.01);
}

TEST(DeviceDynamics, CommandActsAfterExactlyItsDelay) {
    // Truth: invariant; the command of cycle k moves the handle in cycle k + d and not before.
    for (const int d : {0, 1, 3, loop::kMaxDeviceDelayTicks}) {
        DeviceParams p = smoothDevice();
        p.delay_ticks = d;
        DeviceDynamics device(p, {});
        for (int k = 0; k < 200; ++k) {
            const bool pulse = k == 60;
            device.command({Vec3(pulse ? 1.0 : 0.0, 0, 0), Vec3::Zero()});
            device.advance(kNobody);
            EXPECT_EQ(device.actingWrench().force.x(), k == 60 + d ? 1.0 : 0.0) << "d " << d << " k " << k;
            EXPECT_EQ(device.truePose().p.x() > 0, k >= 60 + d) << "d " << d << " k " << k;
        }
    }
}

TEST(DeviceDynamics, MotorsGiveNoMoreThanTheyHave) {
    // Truth: invariant; direction kept, limits of the preset.
    DeviceDynamics sigma(*findPreset("sigma7"), {});
    sigma.command({Vec3(300, 0, 400), Vec3(0, -5, 0)});
    sigma.advance(kNobody);
    EXPECT_NEAR((sigma.actingWrench().force - Vec3(7.2, 0, 9.6)).norm(), 0, 1e-12);
    EXPECT_NEAR((sigma.actingWrench().torque - Vec3(0, -0.2, 0)).norm(), 0, 1e-12);
    DeviceDynamics touch(*findPreset("touch"), {});
    touch.command({Vec3(1, 0, 0), Vec3(1, 1, 1)});
    touch.advance(kNobody);
    EXPECT_EQ(touch.actingWrench().torque, Vec3(0, 0, 0));
    EXPECT_EQ(touch.actingWrench().force, Vec3(1, 0, 0));
}

TEST(DeviceDynamics, ABrokenCommandIsZero) {
    // Truth: invariant; nothing non-finite reaches the mechanism.
    DeviceDynamics device(*findPreset("sigma7"), {});
    device.command({Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3::Zero()});
    device.advance(kNobody);
    EXPECT_EQ(device.actingWrench().force, Vec3(0, 0, 0));
    EXPECT_TRUE(isFinite(device.truePose()));
}

TEST(DeviceDynamics, EncodersReadWholeSteps) {
    // Truth: closed form; a reading is the nearest multiple of the quantum from home, per coordinate.
    DeviceParams p = *findPreset("touch");
    const Pose home{rotationFromVector(Vec3(0, 0.3, 0)), Vec3(0.01, 0, 0)};
    DeviceDynamics device(p, home);
    EXPECT_NEAR((device.readPose().p - home.p).norm(), 0, 1e-15);
    const Vec3 turned(0.0123, -0.0456, 0.001);
    device.place({rotationFromVector(turned) * home.q, home.p + Vec3(1.4, -2.6, 0.49) * p.quantum.value}, {});
    const Pose reading = device.readPose();
    EXPECT_NEAR((reading.p - home.p - Vec3(1, -3, 0) * p.quantum.value).norm(), 0, 1e-15);
    const Vec3 steps = rotationVector(reading.q * home.q.conjugate()) / p.rotational_quantum.value;
    EXPECT_NEAR((steps - Vec3(12, -46, 1)).norm(), 0, 1e-9);
}

TEST(DeviceDynamics, AHandleThatSensesNoRotationDoesNotTurn) {
    // Truth: invariant.
    DeviceDynamics device(*findPreset("falcon"), {});
    HandCoupling hand;
    hand.attached = true;
    hand.inertia = 1e-3;
    hand.rotational_stiffness = 3;
    hand.X_BSet.q = rotationFromVector(Vec3(0.2, 0, 0));
    for (int k = 0; k < 100; ++k) device.advance(hand);
    EXPECT_EQ(device.readPose().q.coeffs(), Quat::Identity().coeffs());
}

TEST(DeviceDynamics, WallIsStableBelowTheExactBorderAndNotAbove) {
    // Truth: closed form (core/loop/stability) against the device in a loop: read, wall, command. 0.9 and 1.1 of the
    // border.
    for (const int d : {0, 1, 2}) {
        DeviceParams p = smoothDevice();
        p.delay_ticks = d;
        p.max_force.value = 1e9;
        const loop::SampledWall wall{.mass = p.mass.value,
                                     .damping = p.damping.value,
                                     .stiffness = 0,
                                     .virtual_damping = 5,
                                     .period = kTickSeconds,
                                     .delay_ticks = d};
        const double border = loop::stableStiffnessBorder(wall);
        for (const double share : {0.9, 1.1}) {
            DeviceDynamics device(p, {});
            device.place({Quat::Identity(), Vec3(1e-4, 0, 0)}, {});
            double last = 1e-4, amplitude = 0;
            for (int k = 0; k < 20000; ++k) {
                const double x = device.readPose().p.x();
                const double force = -share * border * x - wall.virtual_damping * (x - last) / kTickSeconds;
                last = x;
                device.command({Vec3(force, 0, 0), Vec3::Zero()});
                device.advance(kNobody);
                if (k >= 18000) amplitude = std::max(amplitude, std::abs(x));
                if (std::abs(x) > 1.0) {
                    amplitude = 1.0;
                    break;
                }
            }
            if (share < 1) {
                EXPECT_LT(amplitude, 1e-6) << "d " << d;
            } else {
                EXPECT_EQ(amplitude, 1.0) << "d " << d;
            }
        }
    }
}

}  // namespace
