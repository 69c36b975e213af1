#include "core/tick/guidance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/random.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kSpeed = 0.05, kLead = 0.008;           // [m/s], [m]
constexpr double kStiffness = 400.0, kTurning = 1.0;     // [N/m], [N·m/rad]
const Pose kCorner{Quat::Identity(), Vec3(0.05, 0, 0)};  // then on to
const Pose kEnd{rotationFromVector(Vec3(0, 0, 0.5)), Vec3(0.05, 0.04, 0)};

/// A ball in the air with a guide that leads it round a corner.
scene::SceneSpec guidedBall(double share) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.01}, Pose{}, shape::Box{0.06, 0.06, 0.02},
                                        Pose{Quat::Identity(), {0, 0, -1}}, scene::ContactMethod::GodObject);
    spec.parts.resize(1);
    spec.contact.stiffness = 1000.0;
    spec.contact.rotational_stiffness = 0.9;  // a turn of 1 rad is as 30 mm
    spec.effects.guidance = {.share = share,
                             .X_WG = {kCorner, kEnd},
                             .speed = kSpeed,
                             .lead = kLead,
                             .stiffness = kStiffness,
                             .rotational_stiffness = kTurning};
    return spec;
}

TEST(Guidance, WithAShareOfZeroIsNoneToTheLastBit) {
    // Truth: invariant: the hash over all outputs, beside a scene that does not name it.
    auto none = guidedBall(0.0);
    none.effects.guidance = {};
    none.effects.viscosity.damping = 1.0;
    auto zero = guidedBall(0.0);
    zero.effects.viscosity.damping = 1.0;
    test::Bench a(none), b(zero);
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const double t = kTickSeconds * i;
        const Pose X{rotationFromVector(Vec3(0.1 * std::sin(3 * t), 0, 0)), Vec3(0.05 * std::sin(t), 0.01 * t, 0)};
        a.step(X);
        b.step(X);
        ASSERT_EQ(a.wholeState().hash, b.wholeState().hash) << i;
    }
    for (const tick::Stage& stage : b.model().stages) EXPECT_STRNE(stage.name, "guidance");
}

TEST(Guidance, PullsAHandThatIsHeldFastWithShareTimesStiffnessTimesLead) {
    // Truth: closed form: the guide is v t ahead until it is the lead ahead, and waits there.
    for (const double share : {0.25, 1.0}) {
        test::Bench bench(guidedBall(share));
        for (int i = 1; i <= 400; ++i) {
            const auto out = bench.step(Pose{});
            const double ahead = std::min(kLead, kSpeed * kTickSeconds * i);
            EXPECT_LT((out.frame.F_H_W.force - Vec3(share * kStiffness * ahead, 0, 0)).norm(), 1e-9) << i;
            EXPECT_LT(out.frame.F_H_W.torque.norm(), 1e-12);
        }
    }
}

TEST(Guidance, DrawsWhatFollowsFreelyToTheEndAndNoFasterThanTheGuide) {
    // Truth: invariant, of a mass behind a damper, integrated here: 0.3 kg, 6 N·s/m, the same of turning.
    test::Bench bench(guidedBall(1.0));
    constexpr double kMass = 0.3, kDrag = 6.0, kInertia = 1e-3, kTurnDrag = 0.02;
    Pose X;
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
    double fastest = 0.0, farthest = 0.0, before = 0.0;
    for (int i = 0; i < 6000; ++i) {
        const auto out = bench.step(X);
        EXPECT_GE(out.frame.guided, before) << "turned back";
        before = out.frame.guided;
        v += kTickSeconds / kMass * (out.frame.F_H_W.force - kDrag * v);
        w += kTickSeconds / kInertia * (out.frame.F_H_W.torque - kTurnDrag * w);
        X.p += kTickSeconds * v;
        X.q = rotationFromVector(kTickSeconds * w) * X.q;
        fastest = std::max(fastest, v.norm());
        // From the two lines of the way
        const double from_first = Vec3(X.p.x() - std::clamp(X.p.x(), 0.0, 0.05), X.p.y(), X.p.z()).norm();
        const double from_second = Vec3(X.p.x() - 0.05, X.p.y() - std::clamp(X.p.y(), 0.0, 0.04), X.p.z()).norm();
        farthest = std::max(farthest, std::min(from_first, from_second));
    }
    EXPECT_EQ(before, 1.0);
    EXPECT_LT((X.p - kEnd.p).norm(), 1e-4);
    EXPECT_LT(rotationVector(X.q * kEnd.q.conjugate()).norm(), 1e-3);
    EXPECT_LT(fastest, 1.5 * kSpeed);
    EXPECT_LT(farthest, 0.5 * kLead) << "cut the corner";
}

TEST(Guidance, GoesOnWithAHandThatIsFasterAndBackToNobody) {
    // Truth: closed form: on the way nothing pulls along it but what the guide goes ahead, v T; beside it the spring.
    test::Bench bench(guidedBall(1.0));
    for (int i = 0; i <= 100; ++i) {
        const auto out = bench.step(Pose{Quat::Identity(), Vec3(4e-4 * i, 0, 0.002)});
        EXPECT_NEAR(out.frame.F_H_W.force.x(), kStiffness * kSpeed * kTickSeconds, 1e-9) << i;
        EXPECT_NEAR(out.frame.F_H_W.force.z(), -kStiffness * 0.002, 1e-9) << i;
    }
    // Back to the start: it waits where it was.
    tick::TickOutput back;
    for (int i = 99; i >= 0; --i) back = bench.step(Pose{Quat::Identity(), Vec3(4e-4 * i, 0, 0)});
    EXPECT_NEAR(back.frame.F_H_W.force.x(), kStiffness * kLead, 1e-9);
}

TEST(Guidance, FollowsItsShareAndNeverPullsHarder) {
    // Truth: invariant: along the same readings a share is that share of the whole, and no more than the lead's.
    test::Bench whole(guidedBall(1.0)), part(guidedBall(0.3));
    Random random(2);
    for (int i = 0; i < 3000; ++i) {
        const double t = kTickSeconds * i;
        const Pose X{rotationFromVector(Vec3(0.3 * std::sin(2 * t), 0.2 * t, 0)),
                     Vec3(0.02 * t, 0.03 * std::sin(t), 0.02 * std::sin(3 * t))};
        DeviceReading reading{X};
        reading.fresh = random.below(10) != 0;
        if (random.below(200) == 0) reading.X_BD.p.x() = std::nan("");
        const support::RtGuard guard;
        const tick::TickOutput a = whole.step(reading), b = part.step(reading);
        ASSERT_EQ(guard.violations(), 0) << guard.describe();
        EXPECT_LT((0.3 * a.frame.of_guidance.force - b.frame.of_guidance.force).norm(), 1e-12);
        EXPECT_LT((0.3 * a.frame.of_guidance.torque - b.frame.of_guidance.torque).norm(), 1e-12);
        EXPECT_LE(a.frame.of_guidance.force.norm(), kStiffness * kLead * (1 + 1e-12));
        EXPECT_LE(a.frame.of_guidance.torque.norm(), kTurning * kLead / 0.03 * (1 + 1e-9));
    }
}

TEST(Guidance, OfOneHandIsNotOfAnother) {
    // Truth: invariant.
    auto spec = guidedBall(1.0);
    spec.parts.push_back({.name = "other",
                          .geometry = shape::Sphere{0.01},
                          .X_WP = {Quat::Identity(), Vec3(0, 0, 0.5)},
                          .held = true,
                          .hand = 1});
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
    const test::Bench bench(spec);
    const auto has = [](const tick::HandModel& model) {
        return std::any_of(model.stages.begin(), model.stages.end(),
                           [](const tick::Stage& stage) { return std::string(stage.name) == "guidance"; });
    };
    EXPECT_TRUE(has(bench.whole().hands[0]));
    EXPECT_FALSE(has(bench.whole().hands[1]));
}

}  // namespace
}  // namespace passung
