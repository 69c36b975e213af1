#include "core/tick/pick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/tick/step.h"
#include "core/tick/tick_state.h"
#include "tests/support/contact_way.h"
#include "tests/support/length.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// Hands pick parts up, carry them and let them go.

namespace passung {
namespace {

using scene::ContactMethod;
using scene::Geometry;
using shape::Box;
using test::at;
using Way = test::ContactWay;

constexpr double kStiffness = 1000.0;   // [N/m]
constexpr double kTurnStiffness = 0.5;  // [N·m/rad]
constexpr std::uint32_t kButton = 1u << 3;
constexpr double kReach = 0.004;  // [m]

constexpr Way kWays[] = {{"closed_form", ContactMethod::GodObject, Geometry::ClosedForm, 2e-7},
                         {"closed_form_heuristic", ContactMethod::GodObjectHeuristic, Geometry::ClosedForm, 2e-7},
                         {"surface", ContactMethod::GodObject, Geometry::Surface, 3e-6},
                         {"field", ContactMethod::GodObject, Geometry::Field, 6e-6},
                         {"field_heuristic", ContactMethod::GodObjectHeuristic, Geometry::Field, 6e-6}};

class OfEachWay : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(Pick, OfEachWay, testing::ValuesIn(kWays),
                         [](const auto& of) { return std::string(of.param.name); });

/// Rods of 80 × 10 × 10 mm that lie a little above a table, whose top is at z = 0; hands that hold nothing.
constexpr double kLength = 0.08, kWidth = 0.01, kAbove = 1e-4;
scene::SceneSpec rodsOnTable(const Way& way, const std::vector<Pose>& rods, std::size_t hands = 1) {
    scene::SceneSpec spec = test::scene(Box{1, 1, 1}, {}, Box{1, 1, 1}, {}, way.method);
    spec.parts = {{.name = "table", .geometry = Box{0.4, 0.4, 0.02}, .X_WP = at(0, 0, -0.01)}};
    for (std::size_t i = 0; i < rods.size(); ++i)
        spec.parts.push_back({.name = "rod " + std::to_string(i),
                              .geometry = Box{kLength, kWidth, kWidth},
                              .X_WP = rods[i],
                              .pickable = true});
    spec.effects.pick = {.reach = kReach, .button = 4};
    spec.contact.geometry = way.geometry;
    spec.contact.stiffness = kStiffness;
    spec.contact.rotational_stiffness = kTurnStiffness;
    spec.contact.cell = 1e-3;
    spec.contact.spacing = 2.5e-3;
    spec.contact.two_way = true;
    for (std::size_t i = 1; i < hands; ++i)
        spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate, "hand " + std::to_string(i)});
    return spec;
}
Pose lying(double x, double y) { return at(x, y, 0.5 * kWidth + kAbove); }

/// Drives hands by poses of their handles.
class Hands {
public:
    explicit Hands(const scene::SceneSpec& spec)
        : bench_(spec), outputs_(spec.handCount()), readings_(spec.handCount()) {}

    void set(const Pose& X_BD, bool down, std::size_t hand) {
        readings_[hand] = {.X_BD = X_BD, .buttons = down ? kButton : 0u};
    }
    void tick() { tick::step(bench_.whole(), bench_.wholeState(), readings_, outputs_); }
    const tick::TickOutput& step(const Pose& X_BD, bool down, std::size_t hand = 0) {
        set(X_BD, down, hand);
        tick();
        return outputs_[hand];
    }
    void stepWith(const Pose& X_BD, std::uint32_t buttons) {
        readings_[0] = {.X_BD = X_BD, .buttons = buttons};
        tick();
    }
    /// There within `ticks`; the others stay.
    const tick::TickOutput& go(const Pose& X_BD, int ticks, bool down, std::size_t hand = 0) {
        const Pose from = readings_[hand].X_BD;
        for (int i = 1; i <= ticks; ++i) {
            const double share = static_cast<double>(i) / ticks;
            step({from.q.slerp(share, X_BD.q), from.p + share * (X_BD.p - from.p)}, down, hand);
        }
        return outputs_[hand];
    }
    const tick::TickOutput& output(std::size_t hand = 0) const { return outputs_[hand]; }
    const Pose& partAt(std::size_t part) { return bench_.wholeState().X_WP[part]; }
    tick::TickState& state() { return bench_.wholeState(); }
    test::Bench& bench() { return bench_; }

private:
    test::Bench bench_;
    std::vector<tick::TickOutput> outputs_;
    std::vector<DeviceReading> readings_;
};

double apart(const Pose& a, const Pose& b) {
    return (a.p - b.p).norm() + 0.1 * rotationVector(a.q * b.q.conjugate()).norm();
}

TEST(Pick, ClosesOnTheNearestPartWithinReachAndOnNoOther) {
    // Truth: closed form, distances of a point from boxes. Inside a part is at 0. What is out of reach, was let go for
    // good, or is in another hand is not taken.
    struct Case {
        Vec3 point;
        int part;
    };
    const Way& way = kWays[0];
    const double top = kAbove + kWidth;
    const Case cases[] = {
        {Vec3(0, 0, top + 0.0039), 1},      {Vec3(0, 0, top + 0.0041), -1},      {Vec3(0, 0.006, top + 0.001), 1},
        {Vec3(0, 0.0111, 0.008), 2},        {Vec3(0, 0.0089, 0.008), 1},         {Vec3(0, 0.015, top - 0.003), 2},
        {Vec3(0.0428, 0, top + 0.0028), 1}, {Vec3(0.0429, 0, top + 0.0029), -1}, {Vec3(0.02, 0.0002, kWidth / 2), 1}};
    for (const bool on_press : {false, true})
        for (const Case& c : cases) {
            auto spec = rodsOnTable(way, {lying(0, 0), lying(0, 0.02)});
            spec.effects.pick.on_press = on_press;
            Hands hands(spec);
            const Pose X{Quat::Identity(), c.point};
            hands.step(X, false);
            EXPECT_EQ(hands.step(X, true).held, -1) << "holds from the next tick on";
            EXPECT_EQ(hands.step(X, !on_press).held, c.part) << c.point.transpose();
            EXPECT_EQ(hands.step(X, !on_press).held, c.part);
            hands.step(X, on_press);
            EXPECT_EQ(hands.step(X, on_press).held, -1);
        }
}

TEST(Pick, NeitherWhatIsInTwoHandsNorInOneThatKeepsItNorWhatIsLocked) {
    // Truth: the rule of pick.h. Nor, with the penalty, what is in another hand.
    auto spec = rodsOnTable(kWays[0], {lying(0, 0), lying(0, 0.02)}, 3);
    const Pose top = at(0, 0, kAbove + kWidth + 0.001);
    {
        Hands hands(spec);
        for (const std::size_t hand : {0u, 1u, 2u}) {
            hands.step(top, false, hand);
            hands.step(top, true, hand);
        }
        hands.step(top, true, 0);
        EXPECT_EQ(hands.output(0).held, 1);
        EXPECT_EQ(hands.output(1).held, 1);
        EXPECT_EQ(hands.output(2).held, -1) << "a part is in two hands at most";
    }
    spec.other_hands.pop_back();
    {
        auto keeps = spec;
        keeps.parts[1].held = true;
        keeps.parts[1].pickable = false;
        Hands hands(keeps);
        hands.step(top, false, 1);
        hands.step(top, true, 1);
        EXPECT_EQ(hands.step(top, true, 1).held, -1);
    }
    spec.contact.method = ContactMethod::Penalty;
    spec.contact.geometry = Geometry::Field;
    spec.effects.pick.locks = true;
    Hands hands(spec);
    const Pose above = at(0, 0, kAbove + kWidth + 0.001);
    hands.step(above, false, 0);
    hands.step(above, true, 0);
    hands.step(above, false, 1);
    hands.step(above, true, 1);
    hands.step(above, true, 1);
    EXPECT_EQ(hands.output(0).held, 1);
    EXPECT_EQ(hands.output(1).held, -1) << "a part is in one hand";
    hands.step(above, false, 0);
    hands.step(above, false, 1);
    for (const std::size_t hand : {0u, 1u}) {
        hands.step(above, true, hand);
        EXPECT_EQ(hands.step(above, true, hand).held, -1) << "what is let go stays for good";
    }
}

TEST_P(OfEachWay, NothingMovesWhenAHandClosesAndThePartThenFollowsIt) {
    // Truth: closed form. In the air the part goes as if it were one body with the hand from then on, and no wrench is
    // felt: with the part held at a grip of its own, by a handle that is turned, off the hand, scaled and registered.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)});
    spec.registration = {{rotationFromVector(Vec3(0.3, -0.8, 0.5)), Vec3(0.1, 0.2, 0.3)},
                         1.5,
                         {rotationFromVector(Vec3(-0.4, 0.2, 0.9)), Vec3(0.05, -0.02, 0.03)}};
    const auto handleAt = [&](const Pose& X_WD) {
        const Pose scaled = spec.registration.X_WB.inverse() * X_WD * spec.registration.X_DH.inverse();
        const Vec3 lever = X_WD.q * spec.registration.X_DH.inverse().p;
        return Pose{scaled.q, spec.registration.X_WB.inverse() * Vec3(X_WD.p + lever) / 1.5};
    };
    Hands hands(spec);
    const Pose grip{rotationFromVector(Vec3(0.2, 0.4, -1.0)), Vec3(0.03, 0.002, kAbove + kWidth + 0.0005)};
    const Pose rod = hands.partAt(1), in_hand = grip.inverse() * rod;
    hands.step(handleAt(grip), false);
    hands.step(handleAt(grip), true);
    const auto& closed = hands.step(handleAt(grip), true);
    EXPECT_LT(apart(closed.X_WG, rod), 1e-9);
    EXPECT_LT(apart(closed.frame.X_WH, rod), 1e-9);
    EXPECT_LT(closed.F_D_B.force.norm() + closed.F_D_B.torque.norm(), 1e-6);
    Pose hand = grip;
    for (int i = 1; i <= 300; ++i) {
        const double t = std::min(1.0, i / 250.0);
        hand = {rotationFromVector(t * Vec3(0.5, -0.3, 0.8)) * grip.q, grip.p + t * Vec3(0.01, -0.02, 0.05)};
        hands.step(handleAt(hand), true);
    }
    EXPECT_LT(apart(hands.partAt(1), hand * in_hand), 1e-9);
    EXPECT_LT(apart(hands.output().X_WG, hand * in_hand), 1e-9);
    EXPECT_LT(hands.output().F_D_B.force.norm() + hands.output().F_D_B.torque.norm(), 1e-6);
    EXPECT_EQ(hands.output().held, 1);
}

TEST_P(OfEachWay, TheSpringIsWhereTheHandHoldsThePart) {
    // Truth: closed form. A rod that is held at one end, and whose other end is pressed into the table's rim by d: the
    // edge holds it at r = (a, 0, h) from the grip with a normal along z, so that with F along z
    //   d = F (1/K + a²/K_φ)  to first order in the turn, and the hand feels F at the contact:  T = r × F about the
    //   grip.
    const double d = 4e-4;
    auto spec = rodsOnTable(GetParam(), {at(0, 0, 0.5 * kWidth + 2e-4)});
    spec.parts[0].geometry = Box{0.02, 0.4, 0.02};
    spec.parts[0].X_WP = at(0.03, 0, -0.01);
    Hands hands(spec);
    const double x = -0.036;
    const Pose grip = at(x, 0, 0.5 * kWidth + 2e-4);
    hands.step(grip, false);
    hands.step(grip, true);
    const Pose down = at(x, 0, grip.p.z() - 2e-4 - d);
    hands.go(down, 200, true);
    const auto& out = hands.go(down, 200, true);
    // The part turns nose up, so that the table's left edge holds it.
    const double a = 0.02 - x;
    const double F = d / (1.0 / kStiffness + a * a / kTurnStiffness);
    const double of_pose = kStiffness * GetParam().error;
    EXPECT_NEAR(out.F_D_B.force.z(), F, 0.01 * F + of_pose);
    EXPECT_NEAR(out.F_D_B.force.head<2>().norm(), 0.0, 0.02 * F + of_pose);
    EXPECT_NEAR(out.F_D_B.torque.y(), -a * F, 0.01 * a * F + a * of_pose) << "the handle is where the hand holds it";
    EXPECT_NEAR(out.F_D_B.torque.z(), 0.0, 0.02 * a * F);
    EXPECT_NEAR(hands.partAt(1).q.y(), -0.5 * a * F / kTurnStiffness, 0.01 * a * F / kTurnStiffness + 1e-4);
}

TEST_P(OfEachWay, WhatIsLetGoStaysThereForAllAndCanBeTakenAgain) {
    // Truth: geometry. A rod is laid across another one and let go; it stays, to the last bit as the record has it,
    // bears a third one that is laid on it, and can be taken away, by another hand too.
    Hands hands(rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0), lying(0.1, 0.05)}, 2));
    const double top = kAbove + kWidth, error = GetParam().error;
    const auto carry = [&](std::size_t hand, const Vec3& from, const Pose& to) {
        hands.go({Quat::Identity(), from}, 100, false, hand);
        hands.go({Quat::Identity(), from}, 2, true, hand);
        hands.go({Quat::Identity(), from + Vec3(0, 0, 0.05)}, 200, true, hand);
        hands.go({to.q, to.p + Vec3(0, 0, 0.02)}, 400, true, hand);
        hands.go(to, 300, true, hand);
        hands.go(to, 200, true, hand);
    };
    const Quat across = rotationFromVector(Vec3(0, 0, 1.5));
    // Pressed on by 0.2 mm: it lies on the first one, one width higher.
    carry(0, Vec3(0.1, 0, top), {across, Vec3(0, 0, top + kWidth - 2e-4)});
    EXPECT_NEAR(hands.output(0).F_D_B.force.z(), 0.2, 1e-3 * error / 1e-6 + 2e-3);
    EXPECT_NEAR(hands.partAt(2).p.z(), top + 0.5 * kWidth, error);
    const Pose before = hands.partAt(2);
    hands.step({across, Vec3(0, 0, top + kWidth - 2e-4)}, false);
    const Pose& rest = hands.partAt(2);
    EXPECT_LT(apart(rest, before), 2e-8);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(rest.p[i], static_cast<double>(static_cast<float>(rest.p[i])));
    const auto& opened = hands.step({across, Vec3(0, 0, top + kWidth - 2e-4)}, false);
    EXPECT_EQ(opened.held, -1);
    EXPECT_EQ(opened.F_D_B.force.norm() + opened.F_D_B.torque.norm(), 0.0);
    hands.go(at(0, 0, 0.1), 200, false, 0);
    EXPECT_EQ(apart(hands.partAt(2), rest), 0.0);
    // The other hand lays the third rod on it.
    carry(1, Vec3(0.1, 0.05, top), at(0, 0, top + 2 * kWidth - 3e-4));
    EXPECT_EQ(hands.output(1).held, 3);
    EXPECT_NEAR(hands.output(1).F_D_B.force.z(), 0.3, 2e-3 * error / 1e-6 + 2e-3);
    EXPECT_NEAR(hands.partAt(3).p.z(), top + 1.5 * kWidth, 2 * error) << "there are two contacts below it";
    hands.step(at(0, 0, top + 2 * kWidth - 3e-4), false, 1);
    hands.go(at(0, 0, 0.1), 200, false, 1);
    EXPECT_NEAR(hands.partAt(3).p.z(), top + 1.5 * kWidth, 2 * error);
    // And takes it away again, at its side.
    carry(1, Vec3(0.03, 0, top + 1.5 * kWidth), at(0.1, 0.1, 0.05));
    EXPECT_LT((hands.partAt(3).p - Vec3(0.07, 0.1, 0.05)).norm(), 2 * error + 1e-6);
}

TEST_P(OfEachWay, APartInOneHandMeetsThatInTheOther) {
    // Truth: closed form. Pressed together by d between two equal springs, each hand feels K d/2 along the line between
    // them; both were picked up.
    const double gap = 0.004;
    Hands hands(rodsOnTable(GetParam(), {lying(0, 0), lying(0, kWidth + gap)}, 2));
    const double z = kAbove + 0.5 * kWidth, up = 0.05;
    for (const std::size_t hand : {0u, 1u}) {
        const Pose grip = at(0, hand == 0 ? 0.0 : kWidth + gap, z);
        hands.go(grip, 50, false, hand);
        hands.go(grip, 2, true, hand);
        hands.go(at(0, grip.p.y(), z + up), 200, true, hand);
    }
    const double d = 0.001;
    hands.go(at(0, gap + d, z + up), 300, true, 0);
    hands.go(at(0, gap + d, z + up), 200, true, 0);
    const double of_pose = 2 * kStiffness * GetParam().error;
    EXPECT_NEAR(hands.output(0).F_D_B.force.y(), -0.5 * kStiffness * d, of_pose);
    EXPECT_NEAR(hands.output(1).F_D_B.force.y(), 0.5 * kStiffness * d, of_pose);
    // Let go by one hand, it is a wall that rests where it was.
    const Pose rest = hands.partAt(2);
    hands.go(at(0, kWidth + gap, z + up), 200, false, 1);
    EXPECT_LT(apart(hands.partAt(2), rest), 2e-8);
    EXPECT_EQ(hands.output(1).held, -1);
    hands.go(at(0, gap + d, z + up), 200, true, 0);
    EXPECT_NEAR(hands.output(0).F_D_B.force.y(), -0.5 * kStiffness * d, of_pose) << "it rests half way";
    hands.go(at(0, gap + 3 * d, z + up), 300, true, 0);
    EXPECT_NEAR(hands.output(0).F_D_B.force.y(), -2.5 * kStiffness * d, of_pose);
}

TEST_P(OfEachWay, AnyWayOfHandsIsTheSameBitsAgainAndAllocatesNothing) {
    // Truth: invariant. Two hands at random among rods, closing and opening, twice; no part overlaps the table.
    const auto run = [&](double& lowest) {
        Hands hands(rodsOnTable(GetParam(), {lying(0, 0), lying(0.02, 0.03), lying(-0.02, -0.03)}, 2));
        Random random(5);
        std::vector<Pose> X(2, at(0, 0, 0.02));
        std::vector<bool> down(2);
        std::vector<std::int32_t> held(2, -1);
        int picked = 0;
        std::int64_t violations = 0;
        for (int i = 0; i < 6000; ++i)
            for (const std::size_t hand : {0u, 1u}) {
                const double t = 1e-3 * i, phase = hand == 0 ? 0.0 : 2.0;
                X[hand] = {rotationFromVector(0.4 * Vec3(std::sin(t + phase), std::cos(1.3 * t), std::sin(0.7 * t))),
                           Vec3(0.03 * std::sin(2.1 * t + phase), 0.04 * std::cos(1.7 * t + phase),
                                0.012 + 0.012 * std::sin(9 * t + phase))};
                if (random.below(100) == 0) down[hand] = !down[hand];
                {
                    const support::RtGuard guard;
                    hands.step(X[hand], down[hand], hand);
                    violations += guard.violations();
                }
                for (const std::size_t of : {0u, 1u}) {
                    picked += held[of] < 0 && hands.output(of).held >= 0 ? 1 : 0;
                    held[of] = hands.output(of).held;
                }
                for (const std::size_t part : {1u, 2u, 3u})
                    for (int corner = 0; corner < 8; ++corner) {
                        const Vec3 half = 0.5 * Vec3(kLength, kWidth, kWidth);
                        const Vec3 p((corner & 1) != 0 ? half.x() : -half.x(), (corner & 2) != 0 ? half.y() : -half.y(),
                                     (corner & 4) != 0 ? half.z() : -half.z());
                        lowest = std::min(lowest, (hands.partAt(part) * p).z());
                    }
            }
        EXPECT_EQ(violations, 0);
        EXPECT_GT(picked, 4);
        return hands.state().hash;
    };
    double lowest = 1.0, again = 1.0;
    EXPECT_EQ(run(lowest), run(again));
    EXPECT_EQ(lowest, again);
    EXPECT_GT(lowest, -2 * GetParam().error - 1e-5);
}

/// Two hands on one rod, which they lifted `up`: held at `first` and `second`, in the rod.
class Together {
public:
    Together(const scene::SceneSpec& spec, const Vec3& first, const Vec3& second, double up) : hands(spec) {
        const std::array<Vec3, 2> points{first, second};
        for (const std::size_t hand : {0u, 1u}) {
            X[hand] = {rotationFromVector(Vec3(0.3, 0.1, hand == 0 ? 0.5 : -0.4)), hands.partAt(1) * points[hand]};
            hands.go(X[hand], 20, false, hand);
            hands.step(X[hand], true, hand);  // closes at its end
            in_hand[hand] = X[hand].inverse() * hands.partAt(1);
            p_GC[hand] = in_hand[hand].inverse().p;
            hands.step(X[hand], true, hand);
        }
        rod = hands.partAt(1);
        X_closed = X;
        for (const std::size_t hand : {0u, 1u}) X[hand].p.z() += up;
        go(400);
    }
    /// Both there, and at rest.
    void go(int ticks) {
        const std::vector<Pose> from = at;
        for (int i = 1; i <= 2 * ticks; ++i) {
            const double share = std::min(1.0, static_cast<double>(i) / ticks);
            for (const std::size_t hand : {0u, 1u}) {
                const Pose& before = from.empty() ? X_closed[hand] : from[hand];
                hands.set({before.q.slerp(share, X[hand].q), before.p + share * (X[hand].p - before.p)}, true, hand);
            }
            hands.tick();
        }
        at = {X[0], X[1]};
    }
    /// Minus the energy's gradient about the part's origin, at its pose, and the springs' energy: by the definition.
    Wrench springs(const Pose& X_WP) const {
        Wrench sum;
        for (const std::size_t hand : {0u, 1u}) {
            const Pose asked = X[hand] * in_hand[hand];
            const Vec3 e = asked * p_GC[hand] - X_WP * p_GC[hand];
            sum.force += kStiffness * e;
            sum.torque += (X_WP.q * p_GC[hand]).cross(kStiffness * e) +
                          turn_stiffness * rotationVector(asked.q * X_WP.q.conjugate());
        }
        return sum;
    }

    Hands hands;
    std::array<Pose, 2> X, X_closed, in_hand;
    std::array<Vec3, 2> p_GC;
    Pose rod;
    std::vector<Pose> at;
    double turn_stiffness = kTurnStiffness;
};

TEST_P(OfEachWay, TwoSpringsHoldOnePartWhereTheyBalance) {
    // Truth: closed form. In the air, with the hands apart by less or more than their grips, and turned: along the line
    // between the grips the part is in the middle, and it turns as far as both springs say: all forces and torques of
    // the springs, by their definition, add up to nothing. Each hand feels its own spring.
    Together pair(rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2), Vec3(-0.03, 0, 0.004),
                  Vec3(0.035, 0.003, 0), 0.05);
    EXPECT_LT(apart(pair.hands.partAt(1), {pair.rod.q, pair.rod.p + Vec3(0, 0, 0.05)}), 1e-9);
    pair.X[0].p += Vec3(-0.002, 0, 0);
    pair.X[1].p += Vec3(0.001, 0, 0);
    pair.go(200);
    EXPECT_LT((pair.hands.partAt(1).p - pair.rod.p - Vec3(-0.0005, 0, 0.05)).norm(), 2e-5);
    pair.X[0].p += Vec3(0.003, 0.004, -0.001);
    pair.X[1].p += Vec3(0, -0.003, 0.002);
    pair.X[0].q = rotationFromVector(Vec3(0.3, -0.1, 0.05)) * pair.X[0].q;
    pair.X[1].q = rotationFromVector(Vec3(-0.1, 0.2, 0.1)) * pair.X[1].q;
    pair.go(200);
    const Pose& X = pair.hands.partAt(1);
    const Wrench sum = pair.springs(X);
    // The pose is off by no more than the wrench over the stiffness.
    const double off = sum.force.norm() / (2 * kStiffness) + 0.5 * kLength * sum.torque.norm() / (2 * kTurnStiffness);
    std::printf("  %-22s pose of two springs within %.4f um\n", GetParam().name, 1e6 * off);
    EXPECT_LT(sum.force.norm() / (2 * kStiffness), 0.05 * GetParam().error + 1e-9);
    EXPECT_LT(0.5 * kLength * sum.torque.norm() / (2 * kTurnStiffness), 0.05 * GetParam().error + 1e-9)
        << "of the rod's ends [m]";
    Wrench felt;
    for (const std::size_t hand : {0u, 1u}) {
        const auto& out = pair.hands.output(hand);
        EXPECT_EQ(out.held, 1);
        EXPECT_EQ(apart(out.X_WG, X), 0.0);
        const Pose asked = pair.X[hand] * pair.in_hand[hand];
        const Vec3 force = kStiffness * (X * pair.p_GC[hand] - asked * pair.p_GC[hand]);
        EXPECT_GT(force.norm(), 1.0);
        EXPECT_NEAR((out.F_D_B.force - force).norm(), 0.0, 1e-6) << "the handle is where the hand holds it";
        const Vec3 torque = kTurnStiffness * rotationVector(X.q * asked.q.conjugate());
        EXPECT_NEAR((out.F_D_B.torque - torque).norm(), 0.0, 1e-6);
    }
}

TEST_P(OfEachWay, OfTwoHandsOnAPartThatBelongsSomewhereTheFirstIsDrawn) {
    // Truth: the effect's own head comment; that both hands go on for 200 ticks.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2);
    spec.effects.snap = {.stiffness = 200.0, .range = 0.02};
    spec.effects.pick.steps = {{.part = 1, .into = 0, .X_IGoal = at(0, 0, 0.065)}};
    Together pair(spec, Vec3(-0.03, 0, 0.004), Vec3(0.035, 0.003, 0), 0.05);
    pair.X[0].p += Vec3(-0.002, 0, 0);
    pair.go(200);
    const auto &first = pair.hands.output(0).frame, &second = pair.hands.output(1).frame;
    EXPECT_EQ(pair.hands.output(1).held, 1);
    EXPECT_GT(first.of_snap.force.norm(), 0.1);
    EXPECT_EQ(second.of_snap.force, Vec3::Zero());
    EXPECT_TRUE(second.F_H_W.force.allFinite());
}

TEST_P(OfEachWay, TwoSpringsPressOnePartAgainstAWall) {
    // Truth: closed form. Two grips at ±a from the middle, let down by d_1 and d_2 below where the rod lies: the table
    // bears K (d_1 + d_2), each hand feels its own; the rod lies flat. Turned about the line between the grips by φ in
    // both hands, the rod rests on its edge, turned less: the springs' wrench is what the table's force alone does.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2);
    Together pair(spec, Vec3(-0.03, 0, 0), Vec3(0.03, 0, 0), 0.0);
    pair.X[0].p.z() -= kAbove + 4e-4;
    pair.X[1].p.z() -= kAbove + 6e-4;
    pair.go(200);
    const double error = GetParam().error;
    EXPECT_NEAR(pair.hands.partAt(1).p.z(), 0.5 * kWidth, error);
    EXPECT_NEAR(pair.hands.output(0).F_D_B.force.z(), 0.4, 2 * kStiffness * error);
    EXPECT_NEAR(pair.hands.output(1).F_D_B.force.z(), 0.6, 2 * kStiffness * error);
    for (const std::size_t hand : {0u, 1u}) pair.X[hand].q = rotationFromVector(Vec3(0.2, 0, 0)) * pair.X[hand].q;
    pair.go(300);
    const Pose X = pair.hands.partAt(1);
    const double phi = rotationVector(X.q).x();
    EXPECT_GT(phi, 0.05);
    EXPECT_LT(phi, 0.199);
    const double half = 0.5 * kWidth;
    EXPECT_NEAR(X.p.z(), half * (std::cos(phi) + std::sin(phi)), 3 * error) << "it stands on its edge";
    const Wrench sum = pair.springs(X);
    // About the edge, where the table pushes: y of the lower edge from the axis.
    const double lever = half * (std::sin(phi) - std::cos(phi));
    EXPECT_NEAR(sum.force.head<2>().norm(), 0.0, 4 * kStiffness * error);
    EXPECT_NEAR(sum.torque.x(), lever * sum.force.z(), 4 * kStiffness * error * half + 1e-5);
}

TEST_P(OfEachWay, HandsThatPullFarApartHoldThePartStill) {
    // Truth: closed form. Each hand pulls its end along the line between the grips, farther than the springs' own
    // stiffness against turning would bear to be told of an unstretched pair (50 mm where the arm is 20 mm): the part
    // stays in the middle, straight, and does not rattle.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2);
    spec.limits.max_force = 200.0;
    Together pair(spec, Vec3(-0.02, 0, 0), Vec3(0.02, 0, 0), 0.05);
    pair.X[0].p.x() -= 0.05;
    pair.X[1].p += Vec3(0.05, 0, 0.001);
    pair.go(300);
    Pose before = pair.hands.partAt(1);
    double rattle = 0.0;
    for (int i = 0; i < 200; ++i) {
        pair.hands.tick();
        rattle = std::max(rattle, apart(pair.hands.partAt(1), before));
        before = pair.hands.partAt(1);
    }
    EXPECT_LT(rattle, 1e-8 + 0.1 * GetParam().error);
    const Wrench sum = pair.springs(before);
    EXPECT_LT(sum.force.norm(), 2 * kStiffness * (0.05 * GetParam().error + 1e-8));
    EXPECT_LT(sum.torque.norm(), 2 * kTurnStiffness * 1e-5);
    EXPECT_LT(rotationVector(before.q).norm(), 0.05);
}

TEST_P(OfEachWay, ADeviceThatIsElsewhereTearsNoPartOutOfTheOtherHand) {
    // Truth: the rule of pick.h. One device jumps by 1 m and stays there (input_guard.h): its hand holds the part at
    // another point from then on; the part stays, and nobody feels more than before.
    for (const std::size_t jumps : {0u, 1u}) {
        auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2);
        spec.limits.max_speed = spec.other_hands.front().limits.max_speed = 3.0;
        Together pair(spec, Vec3(-0.03, 0, 0.004), Vec3(0.035, 0.003, 0), 0.05);
        const Pose before = pair.hands.partAt(1);
        Pose there = pair.X[jumps];
        there.p.y() += 1.0;
        double most = 0.0;
        std::uint32_t status = 0;
        for (int i = 0; i < 400; ++i) {
            pair.hands.step(there, true, jumps);
            status |= pair.hands.output(jumps).frame.status;
            for (const std::size_t hand : {0u, 1u}) most = std::max(most, pair.hands.output(hand).F_D_B.force.norm());
        }
        EXPECT_TRUE(status & kInputRelocated);
        EXPECT_LT(most, 1e-3);
        EXPECT_LT(apart(pair.hands.partAt(1), before), 1e-6);
        there.p.z() += 0.01;
        pair.hands.go(there, 100, true, jumps);
        EXPECT_EQ(pair.hands.output(jumps).held, 1);
        EXPECT_GT(pair.hands.output(jumps).F_D_B.force.norm(), 1e-3) << "it goes on holding";
    }
}

TEST_P(OfEachWay, WhatWasLaidDownWhileAHandWaitedAtItsGateIsThere) {
    // Truth: geometry. One hand lays a rod under another one's before that one's trial begins.
    auto spec = rodsOnTable(GetParam(), {at(0, 0, 0.06), lying(0.12, 0)}, 2);
    spec.parts[1].held = true;
    spec.start_gate = {.position_tolerance = 1e-3, .angle_tolerance = 0.1, .hold_ticks = 5};
    Hands hands(spec);
    const Pose away = at(0, 0.1, 0.06);
    hands.set(away, false, 0);
    const double top = kAbove + kWidth;
    hands.go(at(0.12, 0, top), 50, false, 1);
    hands.go(at(0.12, 0, top), 2, true, 1);
    hands.go(at(0.12, 0, 0.02), 50, true, 1);
    hands.go(at(0.0, 0, 0.02), 300, true, 1);
    hands.go(at(0.0, 0, top), 100, true, 1);
    hands.step(at(0.0, 0, top), false, 1);
    hands.go(at(0.2, 0, 0.1), 200, false, 1);
    hands.go(at(0, 0, 0.06), 100, false, 0);
    hands.go(at(0, 0, 0.06), 20, false, 0);
    hands.go(at(0, 0, 0.01), 200, false, 0);
    hands.go(at(0, 0, 0.01), 100, false, 0);
    EXPECT_NEAR(hands.partAt(1).p.z(), 1.5 * kWidth + kAbove, 2 * GetParam().error);
    EXPECT_GT(hands.output(0).F_D_B.force.z(), 4.0);
}

TEST(Pick, JoiningAndLeavingGivesNoJolt) {
    // Truth: invariant. With a damper, a second hand that closes on a heavy part, and one that opens, change no force
    // but for what they hold themselves.
    for (const Way& way : kWays) {
        auto spec = rodsOnTable(way, {lying(0, 0)}, 2);
        spec.parts[1].density = 2.0 / (kLength * kWidth * kWidth);
        spec.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
        spec.contact.rotational_stiffness = 5.0;
        spec.contact.damping = 2.0;
        spec.contact.rotational_damping = 0.01;
        spec.effects.transients = {.amplitude = 5.0, .frequency = 100.0, .decay = 0.02};
        Hands hands(spec);
        const Pose grip = at(0.01, 0, kAbove + kWidth);
        hands.go(grip, 2, false, 0);
        hands.go(grip, 2, true, 0);
        hands.go(at(0.01, 0, 0.06), 200, true, 0);
        hands.go(at(0.01, 0, 0.06), 200, true, 0);
        const Vec3 before = hands.output(0).F_D_B.force;
        EXPECT_NEAR(before.z(), -2 * scene::kStandardGravity, 1e-3) << way.name;
        const Pose second = {Quat::Identity(), hands.partAt(1) * Vec3(-0.02, 0, 0.005)};
        double most = 0.0;
        for (int i = 0; i < 20; ++i) {
            hands.step(second, i > 1, 1);
            most = std::max(most, (hands.output(0).F_D_B.force - before).norm());
        }
        ASSERT_EQ(hands.output(1).held, 1) << way.name;
        // The arm of the weight is that of the part, not of the hand, once two hold it: millimetres of it.
        EXPECT_LT(most, 0.1) << way.name;
        hands.step(second, false, 1);
        for (int i = 0; i < 20; ++i) hands.step(second, false, 1);
        EXPECT_NEAR((hands.output(0).F_D_B.force - before).norm(), 0.0, 1e-3) << way.name;
    }
}

TEST_P(OfEachWay, AClutchTakesTheHandOutOfACarriedPartToo) {
    // Truth: closed form. While the clutch is held the part stays; after it the part goes on by the hand's way. Between
    // two parts the hand's place in the scene stays what the clutch made of it: nothing jumps when it closes or opens.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0), lying(0, 0.1)});
    spec.effects.navigation.clutch = {.button = 2};
    Hands hands(spec);
    const Pose grip = at(0.02, 0, kAbove + kWidth);
    hands.go(grip, 20, false);
    hands.go(grip, 2, true);
    hands.go(at(0.02, 0, 0.05), 100, true);
    const Pose lifted = hands.partAt(1);
    const auto clutched = [&](const Pose& to, int ticks, const Pose& from) {
        for (int i = 0; i <= ticks; ++i)
            hands.stepWith({from.q.slerp(1.0 * i / ticks, to.q), from.p + i * (to.p - from.p) / ticks}, kButton | 2u);
    };
    const Pose aside{rotationFromVector(Vec3(0, 0, 0.5)), Vec3(0.1, 0.05, 0.2)};
    clutched(aside, 100, at(0.02, 0, 0.05));
    EXPECT_LT(apart(hands.partAt(1), lifted), 1e-9);
    hands.go(aside, 5, true);
    EXPECT_LT(apart(hands.partAt(1), lifted), 1e-9);
    Pose on = aside;
    on.p.y() += 0.03;
    hands.go(on, 100, true);
    EXPECT_LT((hands.partAt(1).p - lifted.p - Vec3(0, 0.03, 0)).norm(), 1e-9);
    const Pose rest = hands.partAt(1);
    hands.go(on, 3, false);
    const Pose empty = hands.output().frame.X_WH;
    EXPECT_LT((empty.p - rest.p - Vec3(0.02, 0, kWidth / 2)).norm(), 1e-7) << "the hand's point stays at the part";
    hands.go(on, 3, true);
    EXPECT_EQ(hands.output().held, 1);
    EXPECT_LT(apart(hands.partAt(1), rest), 1e-7);
}

TEST(Pick, OnlyNewGoodSamplesOpenAHand) {
    // Truth: the rule of pick.h. A stale tick, or one whose pose is none, says nothing of the button.
    Hands hands(rodsOnTable(kWays[0], {lying(0, 0)}));
    const Pose grip = at(0, 0, kAbove + kWidth);
    hands.step(grip, false);
    hands.step(grip, true);
    std::vector<DeviceReading> readings(1);
    std::vector<tick::TickOutput> outputs(1);
    for (const bool stale : {true, false}) {
        readings[0] = {.X_BD = stale ? grip : Pose{Quat(0, 0, 0, 0), Vec3::Zero()}, .fresh = !stale, .buttons = 0};
        tick::step(hands.bench().whole(), hands.state(), readings, outputs);
        EXPECT_EQ(hands.step(grip, true).held, 1);
        EXPECT_EQ(hands.step(grip, true).held, 1);
    }
}

TEST(Pick, AButtonThatIsDownFromTheStartIsNoPress) {
    // Truth: the rule of pick.h. Neither before the gate opens, nor in a trial's first tick.
    for (const bool gate : {false, true})
        for (const bool on_press : {false, true}) {
            auto spec = rodsOnTable(kWays[0], {lying(0, 0)});
            spec.effects.pick.on_press = on_press;
            if (gate) spec.start_gate = {0.1, 3.0, 5, at(0, 0, 0.02)};
            Hands hands(spec);
            for (int i = 0; i < 20; ++i) EXPECT_EQ(hands.step(at(0, 0, kAbove + kWidth), true).held, -1);
            hands.step(at(0, 0, kAbove + kWidth), false);
            hands.step(at(0, 0, kAbove + kWidth), true);
            EXPECT_EQ(hands.step(at(0, 0, kAbove + kWidth), true).held, 1);
        }
}

TEST(Pick, ClosesOnNoPartThatWouldHangTooFarTurned) {
    // Truth: closed form. |m g| times the grip's distance from the centre over K_φ, at most 1 rad.
    auto spec = rodsOnTable(kWays[0], {lying(0, 0)});
    spec.parts[1].density = 2.0 / (kLength * kWidth * kWidth);
    spec.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
    for (const double x : {0.02, 0.03}) {
        Hands hands(spec);
        const double z = kAbove + 0.5 * kWidth;
        hands.step(at(x, 0, z), false);
        hands.step(at(x, 0, z), true);
        EXPECT_EQ(hands.step(at(x, 0, z), true).held, 2 * scene::kStandardGravity * x < kTurnStiffness ? 1 : -1) << x;
    }
}

TEST_P(OfEachWay, APartInTwoHandsMeetsOneInAThird) {
    // Truth: closed form. Two springs against one: pressed together by d, the part in two hands gives way by d/3, the
    // other by 2 d/3, and 2 K d/3 pushes either.
    Together pair(rodsOnTable(GetParam(), {lying(0, 0), lying(0, 0.03)}, 3), Vec3(-0.03, 0, 0), Vec3(0.03, 0, 0), 0.05);
    const Pose grip = lying(0, 0.03);
    pair.hands.go(grip, 50, false, 2);
    pair.hands.go(grip, 2, true, 2);
    const double d = 0.0015, height = pair.hands.partAt(1).p.z();
    pair.hands.go(at(0, 0.03, height), 300, true, 2);
    pair.hands.go(at(0, kWidth - d, height), 300, true, 2);
    pair.hands.go(at(0, kWidth - d, height), 200, true, 2);
    ASSERT_EQ(pair.hands.output(2).held, 2);
    const double error = 3 * GetParam().error;
    EXPECT_NEAR(pair.hands.partAt(1).p.y(), -d / 3, error);
    EXPECT_NEAR(pair.hands.output(2).F_D_B.force.y(), 2 * kStiffness * d / 3, kStiffness * error);
    for (const std::size_t hand : {0u, 1u})
        EXPECT_NEAR(pair.hands.output(hand).F_D_B.force.y(), -kStiffness * d / 3, kStiffness * error);
}

TEST_P(OfEachWay, APartIsHandedOverWithoutBeingLaidDown) {
    // Truth: closed form. The second hand closes, the first opens: the part goes on with the second, with its grip, and
    // nothing has moved. The other way round likewise.
    for (const bool second_opens : {false, true}) {
        Together pair(rodsOnTable(GetParam(), {lying(0, 0), lying(0.1, 0.1)}, 2), Vec3(-0.03, 0, 0.004),
                      Vec3(0.035, 0.003, 0), 0.05);
        const std::size_t opens = second_opens ? 1 : 0, keeps = 1 - opens;
        const Pose before = pair.hands.partAt(1);
        pair.hands.step(pair.X[opens], false, opens);
        pair.hands.step(pair.X[opens], false, opens);
        EXPECT_EQ(pair.hands.output(opens).held, -1);
        EXPECT_EQ(pair.hands.output(opens).F_D_B.force.norm(), 0.0);
        EXPECT_EQ(pair.hands.output(keeps).held, 1);
        EXPECT_LT(apart(pair.hands.partAt(1), before), 1e-9);
        pair.X[keeps] = {rotationFromVector(Vec3(0, 0.4, 0.2)) * pair.X[keeps].q,
                         pair.X[keeps].p + Vec3(0.01, 0, 0.03)};
        pair.hands.go(pair.X[keeps], 200, true, keeps);
        EXPECT_LT(apart(pair.hands.partAt(1), pair.X[keeps] * pair.in_hand[keeps]), 1e-9);
        // Down on the table.
        Pose down = pair.X[keeps];
        down.p.z() -= 0.1;
        pair.hands.go(down, 400, true, keeps);
        EXPECT_GT(pair.hands.output(keeps).F_D_B.force.z(), 1.0);
        pair.hands.step(down, false, keeps);
        const Pose rest = pair.hands.partAt(1);
        pair.hands.step(down, false, keeps);
        EXPECT_EQ(pair.hands.output(keeps).held, -1);
        EXPECT_EQ(apart(pair.hands.partAt(1), rest), 0.0);
    }
}

TEST_P(OfEachWay, TwoHandsHoldAHeavyPartBetweenTwoPlates) {
    // Truth: closed form. 2 kg between two upright plates with 0.2 mm of play on either side, held still by two hands
    // for 60 s (fields 6, PASSUNG_LONG=1: 60): the wrenches add up to its weight within 0.1 %, and nothing moves.
    auto spec = rodsOnTable(GetParam(), {lying(0, 0)}, 2);
    for (const double side : {-1.0, 1.0})
        spec.parts.push_back({.name = side < 0 ? "left" : "right",
                              .geometry = Box{0.2, 0.02, 0.2},
                              .X_WP = at(0, side * (0.5 * kWidth + 2e-4 + 0.01), 0.1)});
    const double volume = kLength * kWidth * kWidth, weight = 2.0 * scene::kStandardGravity;
    spec.parts[1].density = 2.0 / volume;
    spec.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
    spec.contact.rotational_stiffness = 5.0;
    spec.limits.max_force = 100.0;
    Together pair(spec, Vec3(-0.03, 0, 0.002), Vec3(0.02, 0, 0.002), 0.06);
    pair.turn_stiffness = 5.0;
    Pose still;
    double most = 0.0, moved = 0.0;
    const int ticks = test::atFullLength() || GetParam().geometry != Geometry::Field ? 60'000 : 6'000;
    for (int i = 0; i < ticks; ++i) {
        pair.hands.tick();
        if (i == 0) still = pair.hands.partAt(1);
        moved = std::max(moved, apart(pair.hands.partAt(1), still));
        Vec3 sum = Vec3::Zero();
        for (const std::size_t hand : {0u, 1u}) sum += pair.hands.output(hand).F_D_B.force;
        most = std::max(most, (sum - Vec3(0, 0, -weight)).norm());
    }
    std::printf("  %-22s sum of both wrenches within %.5f %% of the weight, moved %.4f um in %d s\n", GetParam().name,
                100 * most / weight, 1e6 * moved, ticks / 1000);
    EXPECT_LT(most, 1e-3 * weight);
    EXPECT_LT(moved, 1e-9);
    for (const std::size_t hand : {0u, 1u}) EXPECT_LT(pair.hands.output(hand).F_D_B.force.z(), -0.2 * weight);
    // Its torque too: the springs' wrench about the centre of mass is none.
    const Wrench sum = pair.springs(still);
    EXPECT_NEAR((sum.force - Vec3(0, 0, weight)).norm(), 0.0, 1e-3 * weight);
    EXPECT_NEAR(sum.torque.norm(), 0.0, 1e-5);
    // Lifting and lowering it is no gift.
    const double before = pair.hands.output(0).frame.energy + pair.hands.output(1).frame.energy;
    for (Pose& X : pair.X) X.p.z() += 0.05;
    pair.go(300);
    for (Pose& X : pair.X) X.p.z() -= 0.05;
    pair.go(300);
    EXPECT_NEAR(pair.hands.output(0).frame.energy + pair.hands.output(1).frame.energy, before, 1e-3);
}

TEST(Pick, WeighsInTheHandAsFarAsTheHandLiftsIt) {
    // Truth: closed form. Picked up from the table it weighs nothing yet; lifted by m g/K it weighs all; held at one
    // end its torque about the grip is r × m g. Let go it weighs nothing, and the account takes what lifting took.
    for (const Way& way : kWays) {
        auto spec = rodsOnTable(way, {lying(0, 0)});
        spec.parts[1].density = 2500.0;
        spec.contact.rotational_stiffness = 5.0;
        spec.effects.weight.gravity = Vec3(0, 0, -scene::kStandardGravity);
        const double weight = 2500.0 * kLength * kWidth * kWidth * scene::kStandardGravity;
        Hands hands(spec);
        const Pose grip = at(0.03, 0, kAbove + kWidth);
        hands.step(grip, false);
        hands.step(grip, true);
        for (int i = 0; i < 100; ++i) hands.step(grip, true);
        EXPECT_NEAR(hands.output().F_D_B.force.z(), -std::min(weight, kStiffness * kAbove), 0.35 * weight) << way.name;
        const Pose up = at(0.03, 0, 0.05);
        hands.go(up, 500, true);
        const auto& out = hands.step(up, true);
        EXPECT_NEAR(out.F_D_B.force.z(), -weight, 1e-6 * weight) << way.name;
        EXPECT_NEAR(out.F_D_B.torque.y(), -0.03 * weight, 2e-3 * weight * 0.03) << way.name;
        hands.step(up, false);
        const double energy = hands.output().frame.energy;
        hands.step(at(0.03, 0, 0.0501), false);
        EXPECT_EQ(hands.step(at(0.03, 0, 0.0501), false).F_D_B.force.norm(), 0.0);
        EXPECT_NEAR(hands.output().frame.energy, energy, 1e-7) << "lifting a part is not what contact takes";
        EXPECT_GT(energy, -1e-4);
    }
}

}  // namespace
}  // namespace passung
