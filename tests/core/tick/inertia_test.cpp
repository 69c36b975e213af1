#include "core/tick/inertia.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/scene/part_mass.h"
#include "tests/support/contact_way.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// A held part with mass: what it takes to shake it, and that it goes on where nothing stops it.

namespace passung {
namespace {

using Way = test::ContactWay;
using scene::ContactMethod;
using scene::Geometry;

constexpr double kStiffness = 2000.0, kDamping = 3.0;        // [N/m], [N·s/m]
constexpr double kTurnStiffness = 2.0, kTurnDamping = 2e-3;  // [N·m/rad], [N·m·s/rad]
constexpr double kDensity = 7800.0;                          // [kg/m³]
constexpr double T = kTickSeconds;

constexpr Way kClosedForm{"closed_form", ContactMethod::GodObject, Geometry::ClosedForm, 1e-7};
constexpr Way kHeuristic{"closed_form_heuristic", ContactMethod::GodObjectHeuristic, Geometry::ClosedForm, 1e-7};
constexpr Way kField{"field", ContactMethod::GodObject, Geometry::Field, 4e-6};
constexpr Way kFieldHeuristic{"field_heuristic", ContactMethod::GodObjectHeuristic, Geometry::Field, 4e-6};
constexpr Way kSurface{"surface", ContactMethod::GodObject, Geometry::Surface, 3e-6};

/// A steel box of 187 g, its origin in a corner of its middle plane, far above a plate.
scene::SceneSpec boxOverPlate(const Way& way, double height = 0.5) {
    auto spec = test::scene(shape::Box{0.02, 0.04, 0.03}, Pose{Quat::Identity(), Vec3(0, 0, height)},
                            shape::Box{0.2, 0.2, 0.02}, Pose{Quat::Identity(), Vec3(0, 0, -0.01)}, way.method);
    spec.contact.geometry = way.geometry;
    spec.contact.stiffness = kStiffness;
    spec.contact.damping = kDamping;
    spec.contact.rotational_stiffness = kTurnStiffness;
    spec.contact.rotational_damping = kTurnDamping;
    spec.parts[0].density = kDensity;
    spec.effects.inertia.scale = 1.0;
    return spec;
}

constexpr double kMass = kDensity * 0.02 * 0.04 * 0.03;

class OfEachWay : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(Inertia, OfEachWay,
                         testing::Values(kClosedForm, kHeuristic, kField, kFieldHeuristic, kSurface),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(Inertia, WithAScaleOfZeroIsNoneToTheLastBit) {
    // Truth: invariant: the hash over all outputs, beside a scene that does not name it.
    auto zero = boxOverPlate(kClosedForm, 0.02), none = zero;
    zero.effects.inertia.scale = 0.0;
    none.effects.inertia = {};
    none.parts[0].density = 0.0;
    test::Bench a(none), b(zero);
    for (int i = 0; i < 1000; ++i) {
        const Pose X{Quat::Identity(), Vec3(1e-5 * i, 0, 0.02 - 1e-5 * i)};
        a.step(X);
        b.step(X);
        ASSERT_EQ(a.wholeState().hash, b.wholeState().hash) << i;
    }
    for (const tick::Stage& stage : b.model().stages) EXPECT_STRNE(stage.name, "inertia");
}

/// One coordinate of a mass behind a spring and damper whose other end goes along `hand`, by the implicit Euler rule:
/// written apart from the product, one number instead of six.
std::vector<double> massBehind(const std::vector<double>& hand, double mass, double stiffness, double damping) {
    std::vector<double> x{hand.front()};
    double before = hand.front();
    for (std::size_t i = 1; i < hand.size(); ++i) {
        const double now = x.back(), going_on = 2.0 * now - before;
        const double pulled = stiffness * hand[i] + damping / T * (now + hand[i] - hand[i - 1]);
        before = now;
        x.push_back((pulled + mass / (T * T) * going_on) / (stiffness + damping / T + mass / (T * T)));
    }
    return x;
}

TEST_P(OfEachWay, InTheAirTheProxyIsAMassOnTheCouplingsSpringAndDamper) {
    // Truth: the rule of the head comment for one coordinate (massBehind), along and about each axis through the centre
    // of mass, which is the box's origin here: a sum of sines of 2 to 9 Hz.
    const geometry::MassProperties body = *scene::massOf(shape::Shape(shape::Box{0.02, 0.04, 0.03}), kDensity);
    ASSERT_NEAR(body.mass, kMass, 1e-12);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool turns : {false, true}) {
            const auto spec = boxOverPlate(GetParam());
            test::Bench bench(spec);
            const double size = turns ? 0.3 : 0.01;
            std::vector<double> hand;
            for (int i = 0; i < 800; ++i) {
                const double t = i * T, w = 2.0 * std::numbers::pi;
                hand.push_back(size *
                               (std::sin(2.0 * w * t) + 0.5 * std::sin(9.0 * w * t) - 0.2 * std::sin(5.0 * w * t)));
            }
            const std::vector<double> want =
                massBehind(hand, turns ? body.inertia(axis, axis) : body.mass, turns ? kTurnStiffness : kStiffness,
                           turns ? kTurnDamping : kDamping);
            double worst = 0.0;
            for (std::size_t i = 0; i < hand.size(); ++i) {
                const Vec3 along = hand[i] * Vec3::Unit(axis);
                Pose X = spec.parts[0].X_WP;
                turns ? void(X.q = rotationFromVector(along)) : void(X.p += along);
                const auto out = bench.step(X);
                const Vec3 is = turns ? rotationVector(out.X_WG.q) : Vec3(out.X_WG.p - spec.parts[0].X_WP.p);
                worst = std::max(worst, (is - want[i] * Vec3::Unit(axis)).norm());
                // Nothing touches: all that is felt is inertia's.
                ASSERT_TRUE((out.frame.F_H_W.force - out.frame.of_inertia.force).isZero(0.0)) << i;
                ASSERT_EQ(out.frame.contacts, 0u);
            }
            EXPECT_LT(worst, 1e-9) << axis << turns;
        }
}

TEST_P(OfEachWay, AHandThatAcceleratesFeelsMassTimesAcceleration) {
    // Truth: Newton: -m a once the swing has died away, whatever the grip, and no torque about the centre of mass.
    const auto spec = boxOverPlate(GetParam());
    test::Bench bench(spec);
    const double a = 4.0;
    tick::TickOutput out;
    for (int i = 0; i < 700; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.x() += 0.5 * a * i * T * i * T;
        out = bench.step(X);
    }
    EXPECT_NEAR(out.frame.F_H_W.force.x(), -kMass * a, 2e-3 * kMass * a);
    EXPECT_NEAR(out.frame.X_WH.p.x() - out.X_WG.p.x(), kMass * a / kStiffness, 2e-3 * kMass * a / kStiffness);
}

/// Newton's and Euler's equations of a rigid body behind springs and dampers at a point of it, in steps of a hundredth
/// of a tick by the midpoint rule: another rule than the product's, and with the gyroscopic torque that it leaves out.
class FineBody {
public:
    FineBody(const geometry::MassProperties& body, const Vec3& held, const Pose& start)
        : body_(body), held_(held), X_(start) {}

    /// To where the hand goes straight from `a` to `b` in a tick. What the hand feels at its end: force, and torque
    /// about the held point.
    Wrench tick(const Pose& a, const Pose& b) {
        constexpr int kSteps = 100;
        const Vec3 turn = rotationVector(b.q * a.q.conjugate());
        const Twist hand{(b * held_ - a * held_) / T, turn / T};
        Wrench felt;
        for (int i = 0; i < kSteps; ++i) {
            const double h = T / kSteps;
            const auto at = [&](double share) {
                const double s = (i + share) / kSteps;
                return Pose{rotationFromVector(s * turn) * a.q, (1.0 - s) * a.p + s * b.p};
            };
            const State half = advanced(now(), rate(now(), at(0.0), hand, felt), 0.5 * h);
            set(advanced(now(), rate(half, at(0.5), hand, felt), h));
        }
        return felt;
    }
    const Pose& pose() const { return X_; }

private:
    struct State {
        Pose X;
        Vec3 v, w;  // of the centre of mass
    };
    State now() const { return {X_, v_, w_}; }
    void set(const State& s) {
        X_ = s.X;
        v_ = s.v;
        w_ = s.w;
    }
    State advanced(const State& from, const State& rate, double h) const {
        State to = now();
        const Vec3 m = to.X * body_.centre + h * rate.v;
        to.X.q = (rotationFromVector(h * rate.w) * to.X.q).normalized();
        to.X.p = m - to.X.q * body_.centre;
        to.v += h * rate.X.p;
        to.w += h * rate.X.q.vec();
        static_cast<void>(from);
        return to;
    }
    /// Speeds in v and w, accelerations in X.p and X.q.vec().
    State rate(const State& s, const Pose& hand, const Twist& V, Wrench& felt) const {
        const Mat3 R = s.X.q.toRotationMatrix(), I = R * body_.inertia * R.transpose();
        const Vec3 arm = s.X.q * (held_ - body_.centre), c = s.X * held_;
        const Vec3 e = c - hand * held_, psi = rotationVector(s.X.q * hand.q.conjugate());
        const Vec3 vc = s.v + s.w.cross(arm);
        felt.force = kStiffness * e + kDamping * (vc - V.v);
        felt.torque = kTurnStiffness * psi + kTurnDamping * (s.w - V.w);
        const Vec3 torque = -felt.torque - arm.cross(felt.force);
        State r{{}, s.v, s.w};
        r.X.p = -felt.force / body_.mass;
        r.X.q.vec() = I.inverse() * (torque - s.w.cross(I * s.w));
        return r;
    }

    geometry::MassProperties body_;
    Vec3 held_;
    Pose X_;
    Vec3 v_ = Vec3::Zero(), w_ = Vec3::Zero();
};

TEST_P(OfEachWay, APartThatIsHeldAsideOfItsMassMovesAsNewtonAndEulerSay) {
    // Truth: FineBody. A peg of 154 g that is held at its tip, 25 mm from its centre of mass, swung and turned about
    // all axes at once at up to 4 rad/s; the rules differ by half a tick's acceleration and the gyroscopic torque.
    auto spec = boxOverPlate(GetParam());
    spec.parts[0].geometry = shape::Peg{0.02, 0.05, 0.0};
    test::Bench bench(spec);
    const geometry::MassProperties body = *scene::massOf(*bench.scene().parts[0], kDensity);
    ASSERT_NEAR(body.centre.norm(), 0.025, 1e-6);
    const Pose start = spec.parts[0].X_WP;
    FineBody fine(body, Vec3::Zero(), start);
    Pose last = start;
    double force = 0.0, torque = 0.0, off = 0.0, most_force = 0.0, most_torque = 0.0;
    for (int i = 0; i < 1500; ++i) {
        const double t = i * T, s = std::min(1.0, t / 0.5), rise = s * s * s * (10.0 - s * (15.0 - 6.0 * s));
        Pose X = start;
        X.p += rise * Vec3(0.02 * std::sin(7.0 * t), 0.015 * std::sin(11.0 * t), 0.01 * std::sin(9.0 * t));
        X.q =
            rotationFromVector(rise * Vec3(0.4 * std::sin(8.0 * t), 0.3 * std::sin(6.0 * t), 0.3 * std::sin(10.0 * t)));
        const auto out = bench.step(X);
        const Wrench felt = fine.tick(last, X);
        last = X;
        if (i < 20) continue;
        const Wrench& is = out.frame.F_H_W;
        force = std::max(force, (is.force - felt.force).norm());
        torque = std::max(torque, (is.torque - felt.torque).norm());
        off = std::max(off, (out.X_WG.p - fine.pose().p).norm());
        most_force = std::max(most_force, felt.force.norm());
        most_torque = std::max(most_torque, felt.torque.norm());
    }
    std::printf("  %-22s force within %.3f of %.2f N, torque %.4f of %.3f Nm, place %.3f mm\n", GetParam().name, force,
                most_force, torque, most_torque, 1e3 * off);
    EXPECT_GT(most_force, 0.3);
    EXPECT_GT(most_torque, 0.005);
    EXPECT_LT(force, 0.05 * most_force);
    EXPECT_LT(torque, 0.05 * most_torque);
    EXPECT_LT(off, 2e-4);
}

TEST_P(OfEachWay, AgainstAWallItStopsWithoutABounceAndRestsAsWithoutMass) {
    // Truth: closed form. The hand goes 3 mm below where the box lies and stays: the wall pushes by K times that, all
    // of it contact's. The box never comes off again, nothing overlaps by more than the way's own error.
    const auto spec = boxOverPlate(GetParam(), 0.02);
    test::Bench bench(spec);
    const double rest = 0.015;
    bool touched = false;
    tick::TickOutput out;
    for (int i = 0; i < 1500; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() = std::max(rest - 0.003, 0.02 - 0.1 * i * T);
        out = bench.step(X);
        EXPECT_GT(out.X_WG.p.z(), rest - 1e-5 - GetParam().error);
        if (out.frame.contacts > 0 && out.X_WG.p.z() < rest + 2e-6 + GetParam().error) touched = true;
        if (touched) {
            EXPECT_LT(out.X_WG.p.z(), rest + 1e-5 + GetParam().error) << i;
        }
    }
    EXPECT_TRUE(touched);
    EXPECT_NEAR(out.frame.F_H_W.force.z(), kStiffness * 0.003, kStiffness * (GetParam().error + 1e-6));
    EXPECT_LT(out.frame.of_inertia.force.norm(), 1e-3);
    EXPECT_LT((out.frame.F_H_W.torque).norm(), 1e-3);
}

TEST(Inertia, HangsByItsWeightAndFeelsBothTogether) {
    // Truth: closed form: m (g - a) in the steady state of a hand that accelerates; the weight's share is m g alone.
    auto spec = boxOverPlate(kClosedForm);
    spec.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
    test::Bench bench(spec);
    tick::TickOutput out;
    for (int i = 0; i < 700; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() += 0.5 * 2.0 * i * T * i * T;
        out = bench.step(X);
    }
    EXPECT_NEAR(out.frame.of_weight.force.z(), -kMass * scene::kStandardGravity, 1e-9);
    EXPECT_NEAR(out.frame.of_inertia.force.z(), -kMass * 2.0, 2e-3 * kMass * 2.0);
    EXPECT_NEAR(out.frame.F_H_W.force.z(), -kMass * (scene::kStandardGravity + 2.0), 2e-3 * kMass * 2.0);
}

TEST(Inertia, WithoutAnObstacleTheFreePartIsAMassToo) {
    // Truth: massBehind, as above.
    auto spec = boxOverPlate(kClosedForm);
    spec.parts.resize(1);
    test::Bench bench(spec);
    std::vector<double> hand(500);
    for (std::size_t i = 0; i < hand.size(); ++i) hand[i] = 0.01 * std::sin(30.0 * static_cast<double>(i) * T);
    const std::vector<double> want = massBehind(hand, kMass, kStiffness, kDamping);
    for (std::size_t i = 0; i < hand.size(); ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.y() += hand[i];
        EXPECT_NEAR(bench.step(X).X_WG.p.y(), want[i], 1e-9) << i;
    }
}

/// The box at rest between two hands that can take it.
scene::SceneSpec boxForTwoHands() {
    auto spec = boxOverPlate(kClosedForm);
    spec.parts[0].held = false;
    spec.parts[0].pickable = true;
    spec.effects.pick = {.reach = 0.05};
    spec.start_gate.X_WH = {Quat::Identity(), spec.parts[0].X_WP.p + Vec3(0, -0.02, 0)};
    auto second = spec.start_gate;
    second.X_WH.p.y() += 0.04;
    spec.other_hands.push_back({spec.limits, spec.registration, second});
    return spec;
}

TEST(Inertia, TwoHandsOnOnePartFeelItsMassTogether) {
    // Truth: Newton: the sum of what both feel is -m a.
    const auto spec = boxForTwoHands();
    const scene::StartGate& second = spec.other_hands.front().start_gate;
    test::Bench bench(spec);
    std::array<tick::TickOutput, 2> out;
    for (int i = 0; i < 900; ++i) {
        std::array<DeviceReading, 2> readings;
        for (std::size_t h = 0; h < 2; ++h) {
            readings[h].X_BD = h == 0 ? spec.start_gate.X_WH : second.X_WH;
            const double t = std::max(0, i - 100) * T;
            readings[h].X_BD.p.x() += 0.5 * 3.0 * t * t;
            readings[h].buttons = i > 10 + 5 * static_cast<int>(h) ? 1u : 0u;
        }
        tick::step(bench.whole(), bench.wholeState(), readings, out);
    }
    ASSERT_EQ(out[0].held, 0);
    ASSERT_EQ(out[1].held, 0);
    const double sum = out[0].frame.F_H_W.force.x() + out[1].frame.F_H_W.force.x();
    EXPECT_NEAR(sum, -kMass * 3.0, 5e-3 * kMass * 3.0);
    EXPECT_NEAR(out[0].frame.F_H_W.force.x(), 0.5 * sum, 1e-3);
}

TEST(Inertia, ThePartKeepsItsMomentumWhereOneOfTwoHandsLetsGo) {
    // Truth: Newton: both hands go on at the same speed, so that no force is needed, before and after.
    const auto spec = boxForTwoHands();
    const scene::StartGate& second = spec.other_hands.front().start_gate;
    for (const std::size_t first_opens : {std::size_t{0}, std::size_t{1}}) {
        test::Bench bench(spec);
        std::array<tick::TickOutput, 2> out;
        double most = 0.0;
        for (int i = 0; i < 1200; ++i) {
            std::array<DeviceReading, 2> readings;
            for (std::size_t h = 0; h < 2; ++h) {
                readings[h].X_BD = h == 0 ? spec.start_gate.X_WH : second.X_WH;
                const double t = std::max(0, i - 100) * T, rise = 0.3;  // speeds up to 0.2 m/s, then straight on
                readings[h].X_BD.p.x() += t < rise ? 0.1 / rise * t * t : 0.1 * rise + 0.2 * (t - rise);
                readings[h].buttons = i > 10 + 5 * static_cast<int>(h) && !(h == first_opens && i > 900) ? 1u : 0u;
            }
            tick::step(bench.whole(), bench.wholeState(), readings, out);
            const std::size_t left = 1 - first_opens;
            if (i > 880) most = std::max(most, out[left].frame.F_H_W.force.norm());
        }
        EXPECT_LT(most, 0.02) << first_opens;  // from rest it would be 3.9 N
    }
}

TEST_P(OfEachWay, PartsInTwoHandsPressEachOtherAsWithoutMassOnceTheyRest) {
    // Truth: closed form: two equal springs pressed together by d give way by d/2 each, and each hand feels K d/2, all
    // of it contact's; a bit of inertia is left of the last swing. Among fields, where a part that another hand presses
    // lags behind, within a hundredth.
    auto spec = boxOverPlate(GetParam());
    spec.parts[1] = spec.parts[0];
    spec.parts[1].name = "other";
    spec.parts[1].hand = 1;
    spec.parts[1].X_WP.p.x() += 0.0204;
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
    test::Bench bench(spec);
    std::array<tick::TickOutput, 2> out;
    for (int i = 0; i < 2500; ++i) {
        const double share = std::min(1.0, i / 300.0);
        std::array<DeviceReading, 2> readings{DeviceReading{spec.parts[0].X_WP}, DeviceReading{spec.parts[1].X_WP}};
        readings[0].X_BD.p.x() += 0.003 * share;
        readings[1].X_BD.p.x() -= 0.001 * share;
        tick::step(bench.whole(), bench.wholeState(), readings, out);
    }
    const double d = 0.004 - 0.0004, force = kStiffness * d / 2;
    const double error = GetParam().geometry == Geometry::Field ? 0.01 * force : kStiffness * (GetParam().error + 2e-6);
    EXPECT_NEAR(out[0].F_D_B.force.x(), -force, error);
    EXPECT_NEAR(out[1].F_D_B.force.x(), force, error);
    for (const tick::TickOutput& hand : out) EXPECT_LT(hand.frame.of_inertia.force.norm(), error);
}

TEST(Inertia, ShakenAgainstAWallTheHandGetsBackNoMoreThanItPutIn) {
    // Truth: energy, summed here over the hand's motion and the force before it: what the coupling and the mass hold is
    // theirs only for a while. Ways at random among wall and air, in each geometry.
    for (const Way& way : {kClosedForm, kField, kSurface}) {
        const auto spec = boxOverPlate(way, 0.018);
        test::Bench bench(spec);
        Random random(5);
        Pose last = spec.parts[0].X_WP;
        Wrench felt;
        double given = 0.0, most = 0.0;
        Vec3 phase(random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 6));
        for (int i = 0; i < 4000; ++i) {
            const double t = i * T, rise = std::min(1.0, t);
            Pose X = spec.parts[0].X_WP;
            X.p += rise * Vec3(0.004 * std::sin(40.0 * t + phase.x()) - 0.004 * std::sin(phase.x()),
                               0.003 * std::sin(31.0 * t), -0.005 * (1.0 - std::cos(27.0 * t)));
            X.q = rotationFromVector(rise * Vec3(0.05 * std::sin(23.0 * t), 0.05 * std::sin(35.0 * t), 0.0));
            given += felt.force.dot(X.p - last.p) + felt.torque.dot(rotationVector(X.q * last.q.conjugate()));
            most = std::max(most, given);
            felt = bench.step(X).frame.F_H_W;
            last = X;
        }
        std::printf("  %-22s most that the hand had back: %.3f mJ, in all %.1f mJ\n", way.name, 1e3 * most,
                    1e3 * given);
        EXPECT_LT(most, 1e-3) << way.name;
        EXPECT_LT(given, -0.05) << way.name;
    }
}

TEST(Inertia, TheTickNeitherAllocatesNorLocks) {
    // Truth: rt_guard.
    if (!support::RtGuard::available()) GTEST_SKIP();
    const auto spec = boxOverPlate(kSurface, 0.02);
    test::Bench bench(spec);
    for (int i = 0; i < 300; ++i) {
        Pose X = spec.parts[0].X_WP;
        X.p.z() -= 2e-5 * i;
        X.p.x() += 1e-3 * std::sin(0.1 * i);
        const support::RtGuard guard;
        bench.step(X);
        ASSERT_EQ(guard.violations(), 0) << guard.describe();
    }
}

}  // namespace
}  // namespace passung
