#include "core/tick/virtual_coupling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kStiffness = 1000, kDamping = 10, kTurnStiffness = 2, kTurnDamping = 0.02;

/// The stage alone: one tick per call. `sample_periods` as the input guard counts them.
class Coupling {
public:
    Coupling() {
        model_.contact.stiffness = kStiffness;
        model_.contact.damping = kDamping;
        model_.contact.rotational_stiffness = kTurnStiffness;
        model_.contact.rotational_damping = kTurnDamping;
    }
    Wrench render(const Pose& X_WG, const Pose& X_WH, int sample_periods = 1, bool usable = true) {
        tick::TickFrame frame;
        frame.X_WH = X_WH;
        frame.input_usable = usable;
        frame.sample_periods = sample_periods;
        state_.X_WG = X_WG;
        tick::runStage<tick::kVirtualCoupling>(model_, state_, frame);
        return frame.F_H_W;
    }

private:
    tick::HandModel model_;
    tick::HandState state_;
};

/// The hand below and turned against a proxy at rest: moving down at 0.1 m/s and turning at 0.5 rad/s.
constexpr double kSpeed = 0.1, kSpin = 0.5;
Pose hand(int tick) {
    const double t = tick * kTickSeconds;
    return {rotationFromVector(Vec3(0.1 + kSpin * t, 0, 0)), Vec3(0, 0, -0.002 - kSpeed * t)};
}
double forceAt(int tick) { return kStiffness * (0.002 + kSpeed * tick * kTickSeconds) + kDamping * kSpeed; }
double torqueAt(int tick) { return -kTurnStiffness * (0.1 + kSpin * tick * kTickSeconds) - kTurnDamping * kSpin; }

TEST(VirtualCoupling, IsASpringAndADamperAgainstAMovingHand) {
    // Truth: closed form. F = K e + B v, T = K_φ ψ + B_φ ω.
    Coupling coupling;
    coupling.render(Pose{}, hand(0));
    for (int i = 1; i < 20; ++i) {
        const Wrench w = coupling.render(Pose{}, hand(i));
        EXPECT_NEAR(w.force.z(), forceAt(i), 1e-9);
        EXPECT_NEAR(w.torque.x(), torqueAt(i), 1e-9);
    }
}

TEST(VirtualCoupling, KeepsTheDampersLoadThroughAHeldSample) {
    // Truth: closed form. The held tick repeats the wrench; the next sample has the wrench that it would have had. (A
    // rate per tick would give 0 and then twice the damper's 1 N.)
    Coupling coupling;
    for (int i = 0; i < 10; ++i) coupling.render(Pose{}, hand(i));
    const Wrench held = coupling.render(Pose{}, hand(9), 0);
    EXPECT_NEAR(held.force.z(), forceAt(9), 1e-9);
    EXPECT_NEAR(held.torque.x(), torqueAt(9), 1e-9);
    const Wrench next = coupling.render(Pose{}, hand(11), 2);
    EXPECT_NEAR(next.force.z(), forceAt(11), 1e-9);
    EXPECT_NEAR(next.torque.x(), torqueAt(11), 1e-9);
}

TEST(VirtualCoupling, DampsADeviceThatIsSlowerThanTheTickAsIfItWereNot) {
    // Truth: closed form. A sample on every other tick.
    Coupling coupling;
    coupling.render(Pose{}, hand(0));
    for (int i = 1; i < 40; ++i) {
        const bool fresh = i % 2 == 0;
        const Wrench w = coupling.render(Pose{}, hand(fresh ? i : i - 1), fresh ? 2 : 0);
        if (i < 2) continue;
        EXPECT_NEAR(w.force.z(), forceAt(fresh ? i : i - 1), 1e-9) << i;
    }
}

TEST(VirtualCoupling, TakesNoMotionFromWhatLiesBetweenRejectedTicks) {
    // Truth: closed form. The first sample after them has the spring's force only, however far the hand went.
    Coupling coupling;
    for (int i = 0; i < 10; ++i) coupling.render(Pose{}, hand(i));
    coupling.render(Pose{}, hand(9), 0);
    for (int i = 0; i < 5; ++i) coupling.render(Pose{}, hand(9), 0, false);
    Wrench w = coupling.render(Pose{}, hand(50), 7);
    EXPECT_NEAR(w.force.z(), forceAt(50) - kDamping * kSpeed, 1e-9);
    EXPECT_NEAR(w.torque.x(), torqueAt(50) + kTurnDamping * kSpin, 1e-9);
    w = coupling.render(Pose{}, hand(51));
    EXPECT_NEAR(w.force.z(), forceAt(51), 1e-9);
}

TEST(VirtualCoupling, LeavesFreeMotionAloneThroughAHeldSample) {
    // Truth: closed form. The proxy is where the hand is: no stretch, no wrench.
    Coupling coupling;
    for (int i = 0; i < 20; ++i) {
        const bool held = i % 5 == 4;
        const Pose X = hand(held ? i - 1 : i);
        const Wrench w = coupling.render(X, X, held ? 0 : (i % 5 == 0 && i > 0 ? 2 : 1));
        EXPECT_EQ(w.force.norm(), 0.0) << i;
        EXPECT_EQ(w.torque.norm(), 0.0) << i;
    }
}

TEST(VirtualCoupling, NeverPullsTheHandIntoTheSurfaceItLeaves) {
    // Truth: invariant. Leaving at 1 m/s, where the damper alone would pull with 10 N, and in the tick after contact.
    Coupling coupling;
    for (int i = 0; i <= 4; ++i) {
        const Wrench w = coupling.render(Pose{}, {Quat::Identity(), Vec3(0, 0, -0.004 + 0.001 * i)});
        EXPECT_GE(w.force.z(), 0.0) << i;
        if (i == 4) {
            EXPECT_EQ(w.force.norm(), 0.0);
        }
    }
}

TEST(VirtualCoupling, StaysContinuousThroughABadSampleOfAHandThatPressesAndSlides) {
    // Truth: closed form. Into the table at 0.1 m/s and along it at 0.05 m/s: per tick the force may change by K v T,
    // in the tick after the bad sample by twice that. 2 %: the proxy keeps its overlap of the surface to a part of a
    // cell.
    auto spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.02)}, shape::Box{0.08, 0.08, 0.04},
                            {Quat::Identity(), Vec3(0, 0, -0.02)}, scene::ContactMethod::GodObjectHeuristic);
    spec.contact.stiffness = kStiffness;
    spec.contact.damping = kDamping;
    test::Bench bench(spec);
    const double change = kStiffness * kSpeed * kTickSeconds;
    double last = 0;
    for (int i = 0; i < 60; ++i) {
        const double t = i * kTickSeconds;
        DeviceReading reading{Pose{Quat::Identity(), Vec3(0.05 * t, 0, 0.0105 - kSpeed * t)}};
        const bool bad = i == 30 || i == 45;
        if (i == 30) reading.X_BD.p.x() = std::nan("");
        if (i == 45) reading.fresh = false;
        const double force = bench.step(reading).F_D_B.force.z();
        if (i > 10) {
            const bool after = i == 31 || i == 46;
            EXPECT_NEAR(force - last, bad ? 0.0 : after ? 2 * change : change, 0.2 * change) << i;
        }
        last = force;
    }
    EXPECT_GT(last, 5.0);
}

TEST(VirtualCoupling, TakesRoundingForNoStretch) {
    // Truth: invariant. The tick after contact: what rounding leaves of the stretch has no direction to damp along.
    Coupling coupling;
    coupling.render(Pose{}, hand(0));
    const Pose X_WH = hand(1);
    const Wrench w = coupling.render({X_WH.q, X_WH.p + Vec3(3e-18, -1e-20, -2e-18)}, X_WH);
    EXPECT_EQ(w.force, Vec3(Vec3::Zero()));
    EXPECT_EQ(w.torque, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace passung
