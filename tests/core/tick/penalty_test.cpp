#include "core/tick/penalty.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kStiffness = 1000, kDamping = 10, kTurnDamping = 0.02;
constexpr double kSpeed = 0.1, kSpin = 0.5;

/// The stage alone, one tick per call: one contact, 2 mm deep and 10 mm to the right of the held part's origin, pushes
/// up: 2 N and -0.02 N·m about y. The hand moves down at 0.1 m/s and turns against the torque at 0.5 rad/s.
class Contact {
public:
    Contact() {
        model_.contact.variant = scene::PenaltyVariant::Raw;
        model_.contact.stiffness = kStiffness;
        model_.contact.damping = kDamping;
        model_.contact.rotational_damping = kTurnDamping;
        state_.manifold = contact::ContactManifold(1);
    }
    Wrench render(int at_tick, int sample_periods = 1, bool usable = true) {
        const double t = at_tick * kTickSeconds;
        tick::TickFrame frame;
        frame.X_WH = {rotationFromVector(Vec3(0, kSpin * t, 0)), Vec3(0, 0, -kSpeed * t)};
        frame.input_usable = usable;
        frame.sample_periods = sample_periods;
        state_.manifold.clear();
        state_.manifold.tryPush({.position = frame.X_WH.p + Vec3(0.01, 0, 0),
                                 .normal = -Vec3::UnitZ(),
                                 .gradient = Vec3::UnitZ(),
                                 .phi = -0.002,
                                 .area = 1e-6});
        tick::runStage<tick::kPenaltyWrench>(model_, state_, frame);
        return frame.F_H_W;
    }

private:
    tick::HandModel model_;
    tick::HandState state_;
};

constexpr double kForce = 2.0, kTorque = -0.02;
constexpr double kForceDamping = kDamping * kSpeed, kTorqueDamping = -kTurnDamping * kSpin;

void expectDamped(const Wrench& w, int tick) {
    EXPECT_NEAR(w.force.z(), kForce + kForceDamping, 1e-9) << tick;
    EXPECT_NEAR(w.torque.y(), kTorque + kTorqueDamping, 1e-9) << tick;
}

TEST(Penalty, DampsAMovingHandAlsoThroughAHeldSample) {
    // Truth: closed form. The same load and the same velocity on every tick: the same wrench. (A velocity per tick
    // would give 2, 4 and 3 N around the held one.)
    Contact contact;
    contact.render(0);
    for (int i = 1; i < 10; ++i) expectDamped(contact.render(i), i);
    expectDamped(contact.render(9, 0), 10);
    expectDamped(contact.render(11, 2), 11);
    expectDamped(contact.render(12), 12);
}

TEST(Penalty, DampsADeviceThatIsSlowerThanTheTickAsIfItWereNot) {
    // Truth: closed form. A sample on every other tick.
    Contact contact;
    contact.render(0);
    for (int i = 1; i < 40; ++i) {
        const bool fresh = i % 2 == 0;
        const Wrench w = contact.render(fresh ? i : i - 1, fresh ? 2 : 0);
        if (i >= 2) expectDamped(w, i);
    }
}

TEST(Penalty, TakesNoMotionFromWhatLiesBetweenRejectedTicks) {
    // Truth: closed form. Undamped at the first sample after them, however far the hand went.
    Contact contact;
    for (int i = 0; i < 10; ++i) contact.render(i);
    contact.render(9, 0);
    for (int i = 0; i < 5; ++i) contact.render(9, 0, false);
    const Wrench w = contact.render(50, 7);
    EXPECT_NEAR(w.force.z(), kForce, 1e-9);
    EXPECT_NEAR(w.torque.y(), kTorque, 1e-9);
    expectDamped(contact.render(51), 51);
}

TEST(Penalty, StaysContinuousThroughABadSampleOfAHandThatPresses) {
    // Truth: closed form. Into the table at 0.1 m/s: per tick the force rises by K v T, on a held tick by nothing, in
    // the tick after it by twice that. (The distance of a plane is linear, so that its field is exact to its 16 bits:
    // some 0.01 µm or 0.01 mN here.)
    auto spec = test::scene(shape::Sphere{0.02}, {Quat::Identity(), Vec3(0, 0, 0.02)}, shape::Box{0.08, 0.08, 0.04},
                            {Quat::Identity(), Vec3(0, 0, -0.02)}, scene::ContactMethod::Penalty);
    spec.contact.stiffness = kStiffness;
    spec.contact.damping = kDamping;
    test::Bench bench(spec);
    const double change = kStiffness * kSpeed * kTickSeconds;
    double last = 0;
    for (int i = 0; i < 60; ++i) {
        DeviceReading reading{Pose{Quat::Identity(), Vec3(0, 0, 0.0105 - kSpeed * i * kTickSeconds)}};
        const bool bad = i == 30 || i == 45;
        if (i == 30) reading.X_BD.p.x() = std::nan("");
        if (i == 45) reading.fresh = false;
        const double force = bench.step(reading).F_D_B.force.norm();
        if (i > 10) {
            const bool after = i == 31 || i == 46;
            EXPECT_NEAR(force - last, bad ? 0.0 : after ? 2 * change : change, 0.1 * change) << i;
        }
        last = force;
    }
    EXPECT_GT(last, 5.0);
}

}  // namespace
}  // namespace passung
