#include "devices/mouse/mouse_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/rt_guard.h"

namespace passung {
namespace {

using mouse::MouseDevice;
using mouse::Pointer;

const Pose kStart{Quat::Identity(), Vec3(0.02, 0.0, 0.03)};

/// A preset without dry friction, whose rests are where the springs say.
simulated::DeviceParams smooth() {
    simulated::DeviceParams params = *simulated::findPreset("sigma7");
    params.coulomb_force.value = params.coulomb_torque.value = 0.0;
    params.quantum.value = params.rotational_quantum.value = 0.0;
    return params;
}

Pose after(MouseDevice& device, int ticks) {
    Pose X_BD;
    for (int i = 0; i < ticks; ++i) X_BD = device.read().X_BD;
    return X_BD;
}

TEST(MouseDevice, FollowsThePointerInAllSixDegreesAndStaysBehindByTwoOverOmega) {
    // Truth: closed form. A critically damped follower is behind a steady motion v by 2 v/ω; its own damping b adds
    // v b/k, which is left out of the handle's dynamics.
    simulated::DeviceParams params = smooth();
    params.damping.value = params.rotational_damping.value = 0.0;
    Pointer pointer;
    MouseDevice device(params, {}, kStart, pointer);
    const double v = 0.05, w = 0.4;
    Pose X_BD;
    for (int i = 0; i < 1000; ++i) {
        pointer.move(Vec3(0, v * kTickSeconds, 0), Vec3(0, 0, w * kTickSeconds));
        X_BD = device.read().X_BD;
    }
    const double lag = 2.0 / MouseDevice::kFollowing;
    EXPECT_NEAR(X_BD.p.y(), v * (1.0 - lag), v * 1e-3);
    EXPECT_NEAR(rotationVector(X_BD.q).z(), w * (1.0 - lag), w * 1e-3);
    X_BD = after(device, 2000);
    EXPECT_NEAR((X_BD.p - Vec3(0.02, 0.05, 0.03)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((rotationVector(X_BD.q) - Vec3(0, 0, 0.4)).norm(), 0.0, 1e-9);
}

TEST(Pointer, GoesAsFarUnderAHeldKeyHoweverOftenItIsLookedAt) {
    // Truth: closed form, way = speed · time, for as long as somebody says that the key is held.
    for (const double slice : {0.001, 0.02, 0.25, 0.9}) {
        Pointer pointer;
        pointer.place(kStart);
        for (double t = 0.0; t < 1.8 - 1e-9; t += slice) {
            pointer.drive(Vec3(0.04, 0, 0), Vec3(0, 0, 0.6));
            pointer.pass(slice);
        }
        const double seconds = slice * std::ceil(1.8 / slice - 1e-9);
        EXPECT_NEAR(pointer.latest().p.x(), 0.02 + 0.04 * seconds, 1e-9) << slice;
        EXPECT_NEAR(rotationVector(pointer.latest().q).z(), 0.6 * seconds, 1e-9) << slice;
        for (int i = 0; i < 5; ++i) pointer.pass(1.0);
        EXPECT_NEAR(pointer.latest().p.x(), 0.02 + 0.04 * (seconds - slice + std::max(slice, Pointer::kHeld)), 1e-9)
            << "nobody said that it was released";
    }
    Pointer pointer;
    pointer.drive(Vec3(1, 0, 0), Vec3::Zero());
    pointer.drive(Vec3::Zero(), Vec3::Zero());
    pointer.pass(0.5);
    EXPECT_EQ(pointer.latest().p.x(), 0.0) << "released";
}

TEST(MouseDevice, TheCouplingSpringBalancesWhatIsCommanded) {
    // Truth: closed form. At rest k (x_pointer - x) = F_motors, rotation alike.
    const simulated::DeviceParams params = smooth();
    Pointer pointer;
    MouseDevice device(params, {}, kStart, pointer);
    const double w2 = MouseDevice::kFollowing * MouseDevice::kFollowing;
    const double k = w2 * (params.mass.value + MouseDevice::kHandMass);
    const double kr = w2 * (params.inertia.value + MouseDevice::kHandInertia);
    device.command({Vec3(0, 0, 4.0), Vec3(0.1, 0, 0)});
    const Pose X_BD = after(device, 3000);
    EXPECT_NEAR(X_BD.p.z() - kStart.p.z(), 4.0 / k, 1e-9);
    EXPECT_NEAR(rotationVector(X_BD.q).x(), 0.1 / kr, 1e-9);
}

TEST(MouseDevice, NoMouseOvercomesTheMotors) {
    // Truth: closed form. The pull ends at kPull of the limit, so a motor at its limit wins whatever the pointer does.
    const simulated::DeviceParams params = smooth();
    Pointer pointer;
    MouseDevice device(params, {}, kStart, pointer);
    pointer.move(Vec3(0, 0, -5.0), Vec3::Zero());
    for (int i = 0; i < 2000; ++i) {
        device.command({Vec3(0, 0, params.max_force.value), Vec3::Zero()});
        device.read();
    }
    EXPECT_GT(device.read().X_BD.p.z(), kStart.p.z());
}

TEST(MouseDevice, AJumpOfThePointerIsNoJumpOfTheHandle) {
    // Truth: invariant. Readings stay far below the speed at which the input guard calls them broken.
    const simulated::DeviceParams params = *simulated::findPreset("sigma7");
    Pointer pointer;
    MouseDevice device(params, {}, kStart, pointer);
    pointer.move(Vec3(3.0, -2.0, 1.0), Vec3(0, 3.0, 0));
    Pose last = device.read().X_BD;
    double fastest = 0.0, spin = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const Pose now = device.read().X_BD;
        fastest = std::max(fastest, (now.p - last.p).norm() / kTickSeconds);
        spin = std::max(spin, rotationVector(now.q * last.q.conjugate()).norm() / kTickSeconds);
        last = now;
    }
    EXPECT_LT(fastest, 0.1 * device.description().max_speed_m_per_s);
    EXPECT_LT(spin, 0.5 * device.description().max_spin_rad_per_s);
}

TEST(MouseDevice, AReadingCarriesTheButtonsAndTouchesNothingThatWaits) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "the sanitizer owns the functions that are counted";
    Pointer pointer;
    MouseDevice device(*simulated::findPreset("falcon"), {}, kStart, pointer);
    pointer.press(5u);
    EXPECT_EQ(device.read().buttons, 5u);
    support::RtGuard guard;
    for (int i = 0; i < 10000; ++i) {
        device.read();
        device.command({Vec3(0, 0, 1.0), Vec3::Zero()});
    }
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

TEST(Pointer, DoesNotSaveUpWhatTheHandCannotFollow) {
    // Truth: closed form. 100 mm too far and 20 mm of reach leave 20 mm, in the same direction.
    Pointer pointer;
    pointer.place(kStart);
    pointer.move(Vec3(0.06, 0.08, 0.0), Vec3(0, 0, 1.0));
    pointer.keepNear(kStart, 0.02, 0.25);
    EXPECT_NEAR((pointer.latest().p - kStart.p - Vec3(0.012, 0.016, 0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rotationVector(pointer.latest().q) - Vec3(0, 0, 0.25)).norm(), 0.0, 1e-12);
    const Pose before = pointer.latest();
    pointer.keepNear(kStart, 0.03, 0.3);
    EXPECT_EQ(pointer.latest().p, before.p);
}

}  // namespace
}  // namespace passung
