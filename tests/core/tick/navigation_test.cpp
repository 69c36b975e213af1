#include "core/tick/navigation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "tests/support/fields.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr std::uint32_t kClutch = 1u << 1, kScale = 1u << 2;  // buttons 2 and 3

/// A ball of 20 mm over a plate whose top is z = 0; its lowest point at `height`.
scene::SceneSpec ballOverPlate(scene::ContactMethod method, double height,
                               scene::Geometry geometry = scene::Geometry::Field) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.02}, Pose{Quat::Identity(), {0, 0, 0.01 + height}},
                                        shape::Box{0.06, 0.06, 0.02}, Pose{Quat::Identity(), {0, 0, -0.01}}, method);
    spec.contact.geometry = geometry;
    spec.contact.rotational_stiffness = 0.5;
    return spec;
}

scene::SceneSpec alone() {
    auto spec = ballOverPlate(scene::ContactMethod::GodObject, 0.01);
    spec.parts.resize(1);
    return spec;
}

scene::Navigation clutchOnly(bool orientation = true) { return {.clutch = {2, orientation}}; }

/// A device that stands askew, is scaled, and holds the part by an end.
scene::Registration askew(double scale) {
    return {{rotationFromVector({0.3, -0.7, 0.4}), Vec3(0.1, -0.2, 0.3)},
            scale,
            {rotationFromVector({-0.5, 0.2, 0.9}), Vec3(0.03, 0.01, -0.02)}};
}

Pose handleAt(int i) {
    const double t = kTickSeconds * i;
    return {rotationFromVector({0.4 * std::sin(3 * t), 0.3 * t, 0.2 * std::cos(5 * t)}),
            Vec3(0.02 * std::sin(4 * t), 0.05 * t, 0.03 * std::cos(2 * t))};
}

bool same(const Pose& a, const Pose& b) { return a.p == b.p && a.q.coeffs() == b.q.coeffs(); }

/// How far the place and the orientation of two poses differ, together.
double apart(const Pose& a, const Pose& b) { return (a.p - b.p).norm() + rotationVector(a.q * b.q.conjugate()).norm(); }

struct Way {
    scene::ContactMethod method;
    scene::Geometry geometry;
};
constexpr Way kProxies[] = {{scene::ContactMethod::GodObjectHeuristic, scene::Geometry::Field},
                            {scene::ContactMethod::GodObject, scene::Geometry::Field},
                            {scene::ContactMethod::GodObject, scene::Geometry::Surface},
                            {scene::ContactMethod::GodObject, scene::Geometry::ClosedForm}};

TEST(Clutch, LeavesThePartAndGoesOnFromThere) {
    // Truth: closed form. A known motion of the handle, turns included, through a registration that is askew: while the
    // button is held the part stays, to the last bit; afterwards it moves by what the handle moves since the button was
    // seen up: its image by s times the way, the part about that by the same rotation, in world axes.
    for (const double s : {0.25, 1.0, 7.0}) {
        auto spec = alone();
        spec.registration = askew(s);
        spec.effects.navigation = clutchOnly();
        test::Bench bench(spec);
        const Quat R_WB = spec.registration.X_WB.q;
        Pose expected;
        for (int i = 0; i < 900; ++i) {
            const Pose X_BD = handleAt(i), before = handleAt(i - 1);
            const bool held = i % 300 >= 100 && i % 300 < 220;
            const auto output = bench.step(DeviceReading{.X_BD = X_BD, .buttons = held ? kClutch : 0u});
            const Pose X_WH = output.frame.X_WH;
            EXPECT_EQ(output.frame.clutched, held);
            if (i <= 100) {
                EXPECT_TRUE(same(X_WH, tick::registeredPose(spec.registration, X_BD, spec.registration.X_DH)));
                expected = X_WH;
                continue;
            }
            if (i % 300 > 100 && i % 300 <= 220) {
                EXPECT_TRUE(same(X_WH, expected)) << i;
                continue;
            }
            const Quat turn = R_WB * (X_BD.q * before.q.conjugate()) * R_WB.conjugate();
            const Vec3 lever = expected.q * (spec.registration.X_DH.q.conjugate() * spec.registration.X_DH.p);
            const Vec3 image = expected.p - lever + s * (R_WB * (X_BD.p - before.p));
            const Pose next{turn * expected.q, image + turn * lever};
            EXPECT_LT(apart(X_WH, next), 2e-15 * (1 + s)) << i;
            expected = X_WH;
        }
    }
}

TEST(Clutch, OffsetTakesUpTheWayOfTheHand) {
    // Truth: closed form: over a cycle o changes by -s times the hand's way from the sample that shows the button down
    // to the one that shows it up, in scene axes; Q by the hand's turn.
    auto spec = alone();
    spec.registration = askew(3.0);
    spec.effects.navigation = clutchOnly();
    test::Bench bench(spec);
    tick::TickOutput output;
    for (int i = 0; i < 60; ++i)
        output = bench.step(DeviceReading{.X_BD = handleAt(i), .buttons = i >= 20 && i < 50 ? kClutch : 0u});
    const Pose a = handleAt(20), b = handleAt(50);
    // The image keeps R_BD Q, and so the lever does; Q = R_b^T R_a.
    const Vec3 way = spec.registration.X_WB.q * (b.p - a.p);
    EXPECT_LT((output.frame.offset + 3.0 * way).norm(), 1e-14);
    EXPECT_LT(rotationVector(output.frame.turn * (b.q.conjugate() * a.q).conjugate()).norm(), 1e-14);
    EXPECT_EQ(output.frame.scale, 3.0);
}

TEST(Clutch, WithoutOrientationLetsThePartTurnAboutTheHandle) {
    // Truth: closed form: the handle's image stays where it was, the part's orientation is that of the registration at
    // every time, and the part's origin lies by its lever beside the image.
    auto spec = alone();
    spec.registration = askew(2.0);
    spec.effects.navigation = clutchOnly(false);
    test::Bench bench(spec);
    const auto& r = spec.registration;
    Vec3 image = Vec3::Zero();
    for (int i = 0; i < 300; ++i) {
        const Pose X_BD = handleAt(i);
        const bool held = i % 100 >= 50;
        const Pose X_WH = bench.step(DeviceReading{.X_BD = X_BD, .buttons = held ? kClutch : 0u}).frame.X_WH;
        const Vec3 lever = r.X_WB.q * (X_BD.q * r.X_DH.p);
        const Quat R_WH = r.X_WB.q * (X_BD.q * r.X_DH.q);
        EXPECT_LT(rotationVector(X_WH.q * R_WH.conjugate()).norm(), 1e-15) << i;
        if (i == 0)
            image = X_WH.p - lever;
        else if (i % 100 != 0 && i % 100 <= 50)  // neither held nor the sample that shows the button up
            image += 2.0 * (r.X_WB.q * (X_BD.p - handleAt(i - 1).p));
        EXPECT_LT((X_WH.p - lever - image).norm(), 1e-13) << i;
    }
}

/// All that a tick gives back, bit by bit, but for what is told of navigation.
bool sameBits(const tick::TickOutput& a, const tick::TickOutput& b) {
    const TickRecord x = tick::makeRecord(0, DeviceReading{}, a), y = tick::makeRecord(0, DeviceReading{}, b);
    const auto same = [](const auto& p, const auto& q) { return test::bitsOf(p) == test::bitsOf(q); };
    return same(a.frame.X_WH, b.frame.X_WH) && same(a.X_WG, b.X_WG) && same(a.F_D_B, b.F_D_B) &&
           same(x.hand_position_m, y.hand_position_m) && same(x.energy_J, y.energy_J) && x.status == y.status &&
           x.contacts == y.contacts && same(x.navigation_offset_m, y.navigation_offset_m) &&
           same(x.navigation_quaternion, y.navigation_quaternion);
}

TEST(Navigation, ThatIsNotUsedChangesNoBit) {
    // Truth: closed form: o = 0, Q = 1, s the registration's. A hand that presses, slides and loses samples; the
    // buttons of nothing are pressed; drift whose share is 0 is not even built.
    for (const Way& way : kProxies)
        for (const bool weighs : {false, true}) {
            auto plain = ballOverPlate(way.method, 0.002, way.geometry);
            plain.registration = askew(1.0);
            plain.registration.X_WB = plain.parts[0].X_WP * plain.registration.X_DH.inverse();
            if (weighs) {
                plain.parts[0].density = 7850.0;
                plain.effects.weight.gravity = Vec3(0, 0, -9.8);
            }
            auto unused = plain;
            unused.effects.navigation = {.clutch = {2, true}, .second_scale = {3, 0.2}, .drift = {0.0, 0.1}};
            test::Bench a(plain), b(unused);
            Random random(5);
            for (int i = 0; i < 400; ++i) {
                DeviceReading reading{{rotationFromVector({0.02 * std::sin(0.03 * i), 0.0, 0.01 * std::sin(0.02 * i)}),
                                       Vec3(0.001 * std::sin(0.05 * i), 0.0, -0.004 * std::sin(0.01 * i))}};
                reading.fresh = random.below(30) != 0;
                reading.buttons = static_cast<std::uint32_t>(random.below(2)) | 0x108u;
                ASSERT_TRUE(sameBits(a.step(reading), b.step(reading))) << i;
            }
        }
    auto spec = alone();
    spec.effects.navigation.drift.share = 0.0;
    EXPECT_FALSE(spec.effects.navigation.any());
    EXPECT_TRUE(std::isnan(test::Bench(spec).step(Pose{}).frame.scale));
}

TEST(SecondScale, ActsWhileItsButtonIsHeldAndNothingJumps) {
    // Truth: closed form: the part's way is the sum of each tick's, s' R_WB (x_k - x_{k-1}) with the scale of that
    // tick.
    auto spec = alone();
    spec.registration = askew(2.0);
    spec.registration.X_DH.p.setZero();  // no lever: the turn does not move the part
    spec.effects.navigation.second_scale = {3, 0.1};
    test::Bench bench(spec);
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 600; ++i) {
        const bool held = i % 90 > 40;
        const auto output = bench.step(DeviceReading{.X_BD = handleAt(i), .buttons = held ? kScale : 0u});
        const double s = held ? 0.1 : 2.0;
        EXPECT_EQ(output.frame.scale, s);
        p = i == 0 ? output.frame.X_WH.p
                   : Vec3(p + s * (spec.registration.X_WB.q * (handleAt(i).p - handleAt(i - 1).p)));
        EXPECT_LT((output.frame.X_WH.p - p).norm(), 1e-13) << i;
    }
}

TEST(SecondScale, WaitsUntilNothingTouchesSoThatItGivesNoEnergy) {
    // Truth: invariant. A hand presses 1 mm into a plate at scale 1, asks for a tenth, draws back ten times as far as
    // it came, and begins anew. At a tenth in contact each round would give 10 times what it took in, less that: 9 K (1
    // mm)² / 2. The port's own energy, summed here, never is below zero by more than a sampled spring gives: its
    // largest force times one tick's way, a round; the scale changes as soon as nothing touches.
    for (const Way& way : kProxies) {
        auto spec = ballOverPlate(way.method, 1e-3, way.geometry);
        spec.effects.navigation.second_scale = {3, 0.1};
        test::Bench bench(spec);
        double z = spec.parts[0].X_WP.p.z(), energy = 0.0, least = 0.0, peak = 0.0, sampled = 0.0;
        Vec3 sent = Vec3::Zero();
        bool waited = false, changed = false;
        const double step = 2e-5;
        const auto go = [&](double way_z, std::uint32_t buttons) {
            z += way_z;
            energy -= sent.z() * way_z;
            least = std::min(least, energy);
            const auto output =
                bench.step(DeviceReading{.X_BD = {Quat::Identity(), Vec3(0, 0, z)}, .buttons = buttons});
            sent = output.F_D_B.force;
            peak = std::max(peak, sent.norm());
            waited = waited || (buttons != 0 && output.frame.scale == 1.0);
            changed = changed || output.frame.scale == 0.1;
            EXPECT_TRUE(output.frame.scale == 1.0 || output.frame.F_H_W.force.norm() == 0.0);
        };
        for (int round = 0; round < 5; ++round) {
            for (int i = 0; i < 100; ++i) go(-step, 0);
            for (int i = 0; i < 100; ++i) go(step, kScale);
            for (int i = 0; i < 10; ++i) go(0.0, 0);
            sampled += std::exchange(peak, 0.0) * step;
        }
        EXPECT_TRUE(waited);
        EXPECT_TRUE(changed);
        EXPECT_GT(least, -1.01 * sampled) << scene::geometryName(way.geometry);
    }
}

TEST(Drift, IsTheIntegralOfItsRule) {
    // Truth: closed form. Out from the middle along a line to X and back, in steps of any length: within r it is
    // σ s X²/(2 r) each way; beyond r the whole share of the way there. About the middle on a circle, once around:
    // none.
    const double s = 2.5, share = 0.2, r = 0.05;
    const Vec3 home(0.01, -0.02, 0.03), along = Vec3(1, 2, -2) / 3.0;
    auto spec = alone();
    spec.registration = {{rotationFromVector({0.3, -0.7, 0.4}), Vec3(0.1, -0.2, 0.3)}, s, Pose{}};
    spec.effects.navigation.drift = {share, r, home};
    const auto offsetAfter = [&](const std::vector<Vec3>& places) {
        test::Bench bench(spec);
        tick::TickOutput output;
        for (const Vec3& place : places) output = bench.step(Pose{Quat::Identity(), place});
        EXPECT_LT(
            apart(
                output.frame.X_WH,
                {spec.registration.X_WB.q,
                 tick::registeredPose(spec.registration, {Quat::Identity(), places.back()}, spec.registration.X_DH).p +
                     output.frame.offset}),
            1e-14);
        return Vec3(spec.registration.X_WB.q.conjugate() * output.frame.offset);
    };
    Random random(1);
    for (const double X : {0.02, 0.05}) {
        std::vector<Vec3> out{home};
        for (double x = 0.0; x < X;) {
            x = std::min(X, x + random.uniform(1e-5, 1e-3));
            out.push_back(home + x * along);
        }
        std::vector<Vec3> both = out;
        both.insert(both.end(), out.rbegin() + 1, out.rend());
        const double once = share * s * X * X / (2 * r);
        EXPECT_LT((offsetAfter(out) - once * along).norm(), 1e-15);
        EXPECT_LT((offsetAfter(both) - 2 * once * along).norm(), 1e-15);
    }
    std::vector<Vec3> far;
    for (int i = 0; i <= 60; ++i) far.push_back(home + (0.05 + 1e-3 * i) * along);
    EXPECT_LT((offsetAfter(far) - share * s * 0.06 * along).norm(), 1e-15);
    std::vector<Vec3> round;
    for (int i = 0; i <= 400; ++i) {
        const double a = 2 * M_PI * i / 400;
        round.push_back(home + 0.03 * Vec3(std::cos(a), std::sin(a), 0));
    }
    EXPECT_LT(offsetAfter(round).norm(), 1e-15);
}

TEST(Drift, DrawsTheHandHomeBehindAPartThatStays) {
    // Truth: closed form. Who keeps the part in place against the drift, with the hand going to and fro by ±a across
    // the line from home, brings the hand home: x(1 + ...) each way moves o by σ s |way| x/r along the line, and the
    // hand gives way by that over s: x_n+1 = x_n (1 - σ way/r) to first order.
    auto spec = alone();
    const double share = 0.1, r = 0.1, a = 0.004, x0 = 0.05;
    spec.effects.navigation.drift = {share, r};
    test::Bench bench(spec);
    double x = x0;
    const auto first = bench.step(Pose{Quat::Identity(), Vec3(x, 0, 0)});
    const double p = first.frame.X_WH.p.x();
    double way = 0.0;
    Vec3 before(x, 0, 0);
    for (int i = 1; i <= 4000; ++i) {
        const Vec3 now(x, a * std::sin(0.05 * i), 0);
        const auto output = bench.step(Pose{Quat::Identity(), now});
        way += (now - before).norm();
        before = now;
        x -= output.frame.X_WH.p.x() - p;  // the eye follows the part
    }
    EXPECT_NEAR(x / (x0 * std::exp(-share * way / r)), 1.0, 0.02);
    EXPECT_LT(x, 0.65 * x0);
}

TEST(Drift, RestsWithTheHand) {
    // Truth: closed form: no motion, no drift; a reading that flickers between two steps of the encoder is none; lost
    // samples, and the jump of a device that is found elsewhere, are none either.
    auto spec = alone();
    spec.effects.navigation.drift = {0.5, 0.01};
    spec.limits.quantum = 1e-5;
    spec.limits.max_speed = 2.0;
    test::Bench bench(spec);
    Random random(2);
    tick::TickOutput output;
    Vec3 offset = Vec3::Zero();
    for (int i = 0; i < 1000; ++i) {
        const Vec3 flicker(random.below(2) == 0 ? 1e-5 : 0.0, random.below(2) == 0 ? 1e-5 : 0.0, 0.0);
        output = bench.step(Pose{Quat::Identity(), Vec3(0.05, 0.02, 0.01) + flicker});
        EXPECT_LE(output.frame.offset.norm(), 0.5 * 2 * 0.5e-5);  // half a step in two coordinates, once
        if (i > 20) {
            EXPECT_EQ((output.frame.offset - offset).norm(), 0.0) << i;
        }
        offset = output.frame.offset;
    }
    for (int i = 0; i < 400; ++i) {
        DeviceReading reading{{Quat::Identity(), Vec3(0.25, 0.02, 0.01)}};
        reading.fresh = i > 3;
        output = bench.step(reading);
    }
    EXPECT_GT(output.frame.X_WH.p.x(), 0.24);
    EXPECT_EQ((output.frame.offset - offset).norm(), 0.0);
}

TEST(Drift, GoesOnInTheAirWhateverRendersContact) {
    // Truth: closed form of the rule, along a line from the middle: nothing touches, also where a tool of a penalty
    // follows the hand by a spring.
    using enum scene::PenaltyCoupling;
    for (const auto coupling : {Direct, QuasiStatic, Virtual})
        for (const bool weighs : {false, true}) {
            auto spec = ballOverPlate(scene::ContactMethod::Penalty, 0.05);
            spec.contact.coupling = coupling;
            spec.contact.damping = 2.0;
            if (weighs) {
                spec.parts[0].density = 1000.0;
                spec.effects.weight.gravity = Vec3(0, 0, -9.8);
            }
            spec.effects.navigation.drift = {0.3, 0.1, spec.parts[0].X_WP.p};
            test::Bench bench(spec);
            tick::TickOutput output;
            for (int i = 0; i <= 200; ++i) {
                Pose X = spec.parts[0].X_WP;
                X.p.x() += 1e-4 * i;
                output = bench.step(X);
            }
            EXPECT_NEAR(output.frame.offset.x(), 0.3 * 0.02 * 0.02 / 0.2, 1e-12);
        }
}

TEST(Drift, WaitsInContactAndGoesOnAfterwards) {
    // Truth: closed form: the offset stays while a wrench of contact is there, whatever the hand does, and moves before
    // and after.
    for (const Way& way : kProxies) {
        auto spec = ballOverPlate(way.method, 1e-3, way.geometry);
        spec.effects.navigation.drift = {0.3, 0.02, spec.parts[0].X_WP.p};
        test::Bench bench(spec);
        Vec3 offset = Vec3::Zero();
        bool touched = false;
        int moved_in_air = 0;
        double last = 0.0;
        for (int i = 0; i < 300; ++i) {
            Pose X = spec.parts[0].X_WP;
            X.p += Vec3(1e-4 * i, 0, -2.5e-3 * std::sin(M_PI * i / 300));
            const auto output = bench.step(X);
            if (last > 0.0) {
                EXPECT_EQ((output.frame.offset - offset).norm(), 0.0) << i;
            } else if (i > 0) {
                moved_in_air += (output.frame.offset - offset).norm() > 0.0;
            }
            last = output.frame.F_H_W.force.norm();
            touched = touched || last > 0.0;
            offset = output.frame.offset;
        }
        EXPECT_TRUE(touched);
        EXPECT_GT(moved_in_air, 60);
    }
}

TEST(Clutch, FadesTheWrenchAndRelaxesTheCoupling) {
    // Truth: closed form. A hand at rest, 1 mm in a plate, holds the clutch: j ticks later the hand's pose is relaxed
    // by j/50 of the stretch and the wrench, as much of it as that leaves, is sent (1 - j/50)-fold: K e (1 - j/50)². 50
    // ticks later and once the button is up there is none, and the part has not moved.
    for (const Way& way : kProxies) {
        auto spec = ballOverPlate(way.method, -1e-3, way.geometry);
        spec.parts[0].X_WP.p.z() += 2e-3;
        spec.effects.navigation = clutchOnly();
        test::Bench bench(spec);
        Pose X = spec.parts[0].X_WP;
        tick::TickOutput output;
        for (int i = 0; i < 100; ++i) {
            if (i < 50) X.p.z() -= 4e-5;
            output = bench.step(X);
        }
        const Pose X_WG = output.X_WG;
        const Vec3 F = output.F_D_B.force;
        EXPECT_NEAR(F.norm(), 1000.0 * 1e-3, 0.2);
        for (int j = 0; j <= 80; ++j) {
            output = bench.step(DeviceReading{.X_BD = X, .buttons = kClutch});
            const double left = std::max(0.0, 1.0 - j / 50.0);
            EXPECT_LT((output.F_D_B.force - left * left * F).norm(), 2e-2 * F.norm()) << j;
            EXPECT_LT((output.X_WG.p - X_WG.p).norm(), 2e-5) << j;
        }
        for (int i = 0; i < 20; ++i) {
            output = bench.step(X);
            EXPECT_LT(output.F_D_B.force.norm(), 2e-2 * F.norm());
        }
        EXPECT_LT((output.frame.X_WH.p - X_WG.p).norm(), 2e-5);
    }
}

TEST(Clutch, RelaxesWhatItsPartIsTurnedBy) {
    // Truth: closed form. A box that lies flat on a plate is turned by 0.1 rad about x at the hand, which is pressed in
    // by a millimetre: the proxy stays flat but for what the coupling tilts it. After the clutch there is neither force
    // nor torque, and the proxy is where it was. Without `orientation` the torque about the handle stays all the time.
    for (const Way& way : kProxies)
        for (const bool orientation : {true, false}) {
            auto spec = test::scene(shape::Box{0.02, 0.02, 0.02}, Pose{Quat::Identity(), {0, 0, 0.0105}},
                                    shape::Box{0.06, 0.06, 0.02}, Pose{Quat::Identity(), {0, 0, -0.01}}, way.method);
            spec.contact.geometry = way.geometry;
            spec.contact.rotational_stiffness = 0.5;
            spec.effects.navigation = clutchOnly(orientation);
            spec.registration.X_WB = {rotationFromVector({0.4, 1.1, -0.6}), Vec3(0.1, 0.2, 0.3)};
            test::Bench bench(spec);
            Pose X;
            tick::TickOutput output;
            for (int i = 0; i < 300; ++i) {
                if (i < 100)
                    X = spec.registration.X_WB.inverse() *
                        Pose{rotationFromVector({1e-3 * i, 0, 0}), Vec3(0, 0, 0.0105 - 1.5e-5 * i)};
                output = bench.step(X);
            }
            const Pose X_WG = output.X_WG;
            const Wrench before = output.F_D_B;
            ASSERT_GT(before.torque.norm(), 1e-3) << scene::geometryName(way.geometry);
            for (int i = 0; i < 60; ++i) output = bench.step(DeviceReading{.X_BD = X, .buttons = kClutch});
            EXPECT_EQ(output.F_D_B.force.norm(), 0.0);
            EXPECT_EQ(output.F_D_B.torque.norm() > 0.0, !orientation);
            for (int i = 0; i < 5; ++i) output = bench.step(X);
            const double left = orientation ? 2e-2 : 0.3;  // what is turned goes on to press a little
            EXPECT_LT(output.F_D_B.force.norm(), left * before.force.norm()) << scene::geometryName(way.geometry);
            if (!orientation) continue;
            EXPECT_LT(output.F_D_B.torque.norm(), 2e-2 * before.torque.norm()) << scene::geometryName(way.geometry);
            EXPECT_LT(apart(output.X_WG, X_WG), 1e-3);
        }
}

/// Energy that goes into the controller through the handle, from readings and commands alone.
class Port {
public:
    explicit Port(const scene::SceneSpec& spec) : bench_(spec) {}

    const tick::TickOutput& step(const Pose& X_BD, std::uint32_t buttons) {
        if (has_last_)
            energy -= output_.F_D_B.force.dot(X_BD.p - X_BD_.p) +
                      output_.F_D_B.torque.dot(rotationVector(X_BD.q * X_BD_.q.conjugate()));
        X_BD_ = X_BD;
        has_last_ = true;
        output_ = bench_.step(DeviceReading{.X_BD = X_BD, .buttons = buttons});
        return output_;
    }
    double energy = 0.0;  // [J]

private:
    test::Bench bench_;
    tick::TickOutput output_;
    Pose X_BD_;
    bool has_last_ = false;
};

TEST(Clutch, GivesOutNoMoreThanOneTicksMotionHoweverTheHandMoves) {
    // Truth: invariant of the derivation, at the handle's port. Pressed 1 mm in, clutched, and then moved along the
    // wrench, against it, to and fro, aside and turning, at several speeds: what the port gives out from the clutch on
    // is at most what one tick's motion takes from the wrench that was sent. A wrench that is held would give |F| times
    // the way: here up to 40 mm.
    using Motion = std::function<Vec3(double)>;
    const Motion motions[] = {[](double t) { return Vec3(0, 0, 0.2 * t); },
                              [](double t) { return Vec3(0, 0, -0.2 * t); },
                              [](double t) { return Vec3(0, 0, 2e-3 * std::sin(200 * t)); },
                              [](double t) { return Vec3(0.2 * t, 0, 0.01 * t); },
                              [](double t) { return Vec3(0.01 * std::sin(60 * t), 0, 4e-3 * std::sin(90 * t)); }};
    std::vector<Way> ways(std::begin(kProxies), std::end(kProxies));
    ways.push_back({scene::ContactMethod::Penalty, scene::Geometry::Field});
    for (const Way& way : ways)
        for (const Motion& motion : motions)
            for (const bool turning : {false, true}) {
                auto spec = ballOverPlate(way.method, 1e-3, way.geometry);
                spec.registration.X_DH.p = Vec3(0.005, 0, 0);
                spec.registration.X_WB = spec.parts[0].X_WP * spec.registration.X_DH.inverse();
                spec.contact.damping = 2.0;
                spec.effects.navigation = clutchOnly();
                Port port(spec);
                Pose X;
                for (int i = 0; i < 200; ++i) {
                    if (i < 100) X.p.z() -= 2e-5;
                    port.step(X, 0);
                }
                const Pose from = X;
                const double before = port.energy;
                Pose last = X;
                double most = 0.0;
                port.step(X, kClutch);
                for (int i = 1; i <= 200; ++i) {
                    const double t = kTickSeconds * i;
                    X.p = from.p + motion(t);
                    if (turning) X.q = rotationFromVector({0.3 * std::sin(40 * t), 0.2 * t, 0.0});
                    const auto& output = port.step(X, kClutch);
                    // |F| ≤ 1.3 N, its lever 5 mm
                    most = std::max(
                        most, 1.3 * (X.p - last.p).norm() + 0.0065 * rotationVector(X.q * last.q.conjugate()).norm());
                    last = X;
                    EXPECT_GE(port.energy - before, -most) << i;
                    EXPECT_LT(output.F_D_B.force.norm(), 1.3);  // K e, a little more where the ball is sampled
                    if (i > 50) {
                        EXPECT_EQ(output.F_D_B.force.norm() + output.F_D_B.torque.norm(), 0.0) << i;
                    }
                }
            }
}

TEST(Clutch, CyclesGiveNoEnergy) {
    // Truth: invariant at the handle's port. Thirty times: pressed in, clutched, drawn back by 3 mm, let go. With a
    // held wrench each would give 1 N over 3 mm. Each cycle presses anew, so that energy only goes in: what the springs
    // hold when the clutch comes is lost, and E ≥ 0 but for a tick's sampling a cycle.
    std::vector<Way> ways(std::begin(kProxies), std::end(kProxies));
    ways.push_back({scene::ContactMethod::Penalty, scene::Geometry::Field});
    for (const Way& way : ways)
        for (const bool orientation : {true, false}) {
            auto spec = ballOverPlate(way.method, 1e-3, way.geometry);
            spec.effects.navigation = clutchOnly(orientation);
            Port port(spec);
            double z = spec.parts[0].X_WP.p.z(), least = 0.0;
            const auto go = [&](int ticks, double step, std::uint32_t buttons) {
                for (int i = 0; i < ticks; ++i) {
                    z += step;
                    port.step({Quat::Identity(), Vec3(0, 0, z)}, buttons);
                    least = std::min(least, port.energy);
                }
            };
            for (int cycle = 0; cycle < 30; ++cycle) {
                go(100, cycle == 0 ? -2e-5 : 0.0, 0);
                go(60, 5e-5, kClutch);
                go(40, -1e-5, 0);
                go(40, 1e-5, 0);
            }
            EXPECT_GT(least, -30 * 1.3 * 5e-5) << scene::geometryName(way.geometry);
        }
}

TEST(Clutch, OfAPenaltyGivesBackWhatItTookIn) {
    // Truth: closed form. Penalty at the hand has no proxy that could be relaxed: the part stays where it is, and the
    // wrench is back when the button is up, whole, at whatever place the hand is then.
    auto spec = ballOverPlate(scene::ContactMethod::Penalty, 1e-3);
    spec.effects.navigation = clutchOnly();
    test::Bench bench(spec);
    Pose X = spec.parts[0].X_WP;
    tick::TickOutput output;
    for (int i = 0; i < 100; ++i) {
        X.p.z() -= 2e-5;
        output = bench.step(X);
    }
    const Wrench F = output.F_D_B;
    for (int i = 0; i < 80; ++i) {
        if (i > 0) X.p += Vec3(1e-4, 0, 2e-4);
        output = bench.step(DeviceReading{.X_BD = X, .buttons = kClutch});
    }
    EXPECT_EQ(output.F_D_B.force.norm(), 0.0);
    EXPECT_LT((bench.step(X).F_D_B.force - F.force).norm(), 1e-12);
}

TEST(Clutch, SendsTheShareThatItsGripLeaves) {
    // Truth: closed form, of the stage alone: F' = g F; with `orientation` T' = g T; without it the torque about the
    // handle, T + (p_H - p_I) x F, is the same before and after. Pushes likewise, the weight's g-fold in both.
    // Released: all but the weight is whole.
    const auto spec = alone();
    const test::Bench bench(spec);
    for (const bool orientation : {true, false})
        for (const bool held : {true, false}) {
            tick::HandModel model = bench.model();
            model.registration = askew(2.0);
            model.effects.navigation = clutchOnly(orientation);
            model.weight = Vec3(0.1, 0.2, -0.7);
            tick::HandSample hand;
            hand.X_WH = {rotationFromVector({0.1, 0.5, -0.3}), Vec3(0.2, 0.1, 0.0)};
            const tick::Grip grip{.X_DG = model.registration.X_DH};
            tick::HandMapping mapping;
            mapping.clutch.held = held;
            mapping.clutch.grip = 0.3;
            const Wrench contact{Vec3(1, -2, 3), Vec3(0.1, 0.2, -0.1)}, weight{model.weight, Vec3(0.01, 0, 0.02)};
            tick::Pushes pushes;
            pushes.pushes.resize(2);
            pushes.pushes[0] = {contact, 2.0};
            pushes.pushes[1] = {weight, 0.0};
            tick::HandWrench wrench;
            wrench.F_H_W = {contact.force + weight.force, contact.torque + weight.torque};
            tick::fadeWrench(model, hand, grip, mapping, pushes, wrench);
            const double share = held ? 0.3 : 1.0;
            const Wrench left = pushes.pushes[0].wrench, hung = pushes.pushes[1].wrench;
            EXPECT_LT((left.force - share * contact.force).norm(), 1e-15);
            const Vec3 lever = tick::leverOf(hand, grip);
            const Vec3 about = left.torque + lever.cross(left.force),
                       whole = contact.torque + lever.cross(contact.force);
            EXPECT_LT((orientation ? Vec3(left.torque - share * contact.torque) : Vec3(about - whole)).norm(), 1e-15);
            EXPECT_LT((hung.force - 0.3 * weight.force).norm() + (hung.torque - 0.3 * weight.torque).norm(), 1e-15);
            EXPECT_LT((wrench.F_H_W.force - left.force - hung.force).norm(), 1e-15);
            EXPECT_LT((wrench.F_H_W.torque - left.torque - hung.torque).norm(), 1e-15);
            EXPECT_EQ(pushes.pushes[0].pressure, 2.0 * share);
        }
}

TEST(ContactSign, IsAWrenchOrThroughAVirtualToolContacts) {
    // Truth: closed form, of the stage alone.
    const test::Bench god_object(ballOverPlate(scene::ContactMethod::GodObject, 1e-3));
    auto coupled = ballOverPlate(scene::ContactMethod::Penalty, 1e-3);
    coupled.contact.coupling = scene::PenaltyCoupling::Virtual;
    const test::Bench tool(coupled);
    for (const bool force : {false, true})
        for (const bool torque : {false, true})
            for (const std::uint32_t contacts : {0u, 3u}) {
                tick::ContactRecord record;
                record.contacts = contacts;
                tick::HandWrench wrench;
                if (force) wrench.F_H_W.force.x() = 1e-6;
                if (torque) wrench.F_H_W.torque.y() = 1e-9;
                tick::ContactSign sign;
                tick::noteContact(god_object.model(), record, wrench, sign);
                EXPECT_EQ(sign.touching, force || torque);
                tick::noteContact(tool.model(), record, wrench, sign);
                EXPECT_EQ(sign.touching, contacts > 0);
            }
}

TEST(Clutch, OfAHeavyPartThatIsTakenAtAnotherTurnLeavesItsWeightOutOfTheAccount) {
    // Truth: closed form. A peg by its end turns with the hand, is clutched while the hand turns on, and turns with it
    // again: its weight's torque does work, which its potential pays; what holding the torque for a tick gives out is
    // at most |τ| ω² T/2 a second.
    auto spec = alone();
    spec.parts[0].geometry = shape::Peg{0.01, 0.06, 0.001};
    spec.parts[0].density = 7850.0;
    spec.effects.weight.gravity = Vec3(0, 0, -9.8);
    spec.effects.navigation = clutchOnly();
    test::Bench bench(spec);
    const double omega = 1.5, torque = 7850.0 * M_PI / 4 * 1e-4 * 0.06 * 9.8 * 0.03;
    for (int i = 0; i < 1500; ++i) {
        const Pose X{rotationFromVector({omega * kTickSeconds * i, 0, 0}), Vec3::Zero()};
        const bool held = i >= 400 && i < 900;
        const auto output = bench.step(DeviceReading{.X_BD = X, .buttons = held ? kClutch : 0u});
        // While the wrench fades its torque is on a handle that turns without the part: up to |τ| ω 50 ms/2.
        const double faded = i > 400 ? torque * omega * 0.026 : 0.0;
        EXPECT_LE(std::abs(output.frame.energy), torque * omega * omega * 1e-3 * 1.5 / 2 + faded + 1e-12) << i;
    }
}

TEST(Clutch, TakesTheWeightAndGivesItBack) {
    // Truth: closed form. In the air F = m g; clutched it fades and comes back in 50 ticks each, the part stays; the
    // account leaves out the weight by the share that was sent, so that lifting and letting down at any time leave it
    // at 0.
    for (const bool proxy : {true, false}) {
        auto spec = ballOverPlate(scene::ContactMethod::GodObject, 0.01, scene::Geometry::ClosedForm);
        if (!proxy) spec.parts.resize(1);
        spec.parts[0].density = 7850.0;
        spec.effects.weight.gravity = Vec3(0, 0, -9.8);
        spec.effects.navigation = clutchOnly();
        test::Bench bench(spec);
        const double weight = 7850.0 * M_PI / 6 * 8e-6 * 9.8;
        Pose X = spec.parts[0].X_WP;
        Pose X_WG;
        for (int i = 0; i < 600; ++i) {
            X.p.z() = 0.02 + 0.004 * std::sin(0.03 * i);
            const bool held = i >= 100 && i < 300;
            const auto output = bench.step(DeviceReading{.X_BD = X, .buttons = held ? kClutch : 0u});
            const double share = i < 100    ? 1.0
                                 : i <= 300 ? std::max(0.0, 1.0 - (i - 100) / 50.0)
                                            : std::min(1.0, (i - 300) / 50.0);
            EXPECT_NEAR(output.F_D_B.force.z(), -share * weight, 1e-9) << i;
            EXPECT_NEAR(output.frame.energy, 0.0, 1e-12) << i;
            if (i > 100 && i <= 300) {
                EXPECT_LT(apart(output.X_WG, X_WG), 1e-9) << i;
            }
            X_WG = output.X_WG;
        }
    }
}

TEST(Navigation, OfEachHandIsItsOwn) {
    // Truth: closed form: what one hand's buttons do leaves the other hand's part where its registration says.
    auto spec = ballOverPlate(scene::ContactMethod::GodObject, 0.05, scene::Geometry::ClosedForm);
    spec.parts.push_back({.name = "other",
                          .geometry = shape::Sphere{0.01},
                          .X_WP = {Quat::Identity(), Vec3(0.1, 0, 0.06)},
                          .held = true,
                          .hand = 1});
    spec.other_hands.push_back({spec.limits, spec.registration, spec.start_gate});
    spec.effects.navigation = {.clutch = {2, true}, .second_scale = {3, 0.5}};
    spec.other_hands[0].navigation = {.clutch = {1, true}};
    test::Bench bench(spec);
    std::array<DeviceReading, 2> readings;
    std::array<tick::TickOutput, 2> outputs;
    std::array<Pose, 2> before;
    for (int i = 0; i < 200; ++i) {
        const Vec3 way(0.0, 1e-4 * i, 0.0);
        readings[0] = {.X_BD = {Quat::Identity(), spec.parts[0].X_WP.p + way},
                       .buttons = i >= 50 && i < 80 ? kClutch : 0u};
        readings[1] = {.X_BD = {Quat::Identity(), spec.parts[2].X_WP.p + way},
                       .buttons = i >= 120 && i < 160 ? 1u : kClutch | kScale};
        tick::step(bench.whole(), bench.wholeState(), readings, outputs);
        for (std::size_t hand = 0; hand < 2 && i > 0; ++hand) {
            const int down = hand == 0 ? 50 : 120, up = hand == 0 ? 80 : 160;
            EXPECT_EQ(outputs[hand].frame.clutched, i >= down && i < up);
            EXPECT_NEAR((outputs[hand].frame.X_WH.p - before[hand].p).y(), i > down && i <= up ? 0.0 : 1e-4, 1e-15);
        }
        for (std::size_t hand = 0; hand < 2; ++hand) before[hand] = outputs[hand].frame.X_WH;
        EXPECT_EQ(outputs[1].frame.scale, 1.0);
    }
}

TEST(Navigation, BeginsWithTheTrialAndWithGoodSamples) {
    // Truth: closed form: before the start gate opens a button does nothing, so that the start pose is where the
    // registration has it; a sample that is not fresh presses no button.
    auto spec = alone();
    spec.start_gate = {1.0, 3.0, 20};
    spec.effects.navigation = {.clutch = {2, true}, .drift = {0.5, 0.01}};
    test::Bench bench(spec);
    for (int i = 0; i < 60; ++i) {
        const Pose X{Quat::Identity(), Vec3(1e-4 * i, 0, 0.02)};
        const auto output = bench.step(DeviceReading{.X_BD = X, .buttons = kClutch});
        if (i <= 20) {
            EXPECT_TRUE(same(output.frame.X_WH, X)) << i;
        }
        EXPECT_EQ(output.frame.clutched, i > 20) << i;
    }
    test::Bench stale(alone());
    auto clutched = alone();
    clutched.effects.navigation = clutchOnly();
    test::Bench lost(clutched);
    for (int i = 0; i < 60; ++i) {
        DeviceReading reading{.X_BD = {Quat::Identity(), Vec3(1e-4 * i, 0, 0.02)}};
        reading.fresh = i % 7 != 3;
        reading.buttons = reading.fresh ? 0u : kClutch;
        EXPECT_FALSE(lost.step(reading).frame.clutched);
    }
}

TEST(Navigation, AllocatesLocksAndWritesNothing) {
    // Truth: invariant, counted by the guard: buttons that come and go in contact and in the air, a part that weighs.
    if (!support::RtGuard::available()) GTEST_SKIP();
    auto spec = ballOverPlate(scene::ContactMethod::GodObject, 1e-3, scene::Geometry::ClosedForm);
    spec.parts[0].density = 7850.0;
    spec.effects.weight.gravity = Vec3(0, 0, -9.8);
    spec.effects.navigation = {.clutch = {2, true}, .second_scale = {3, 0.5}, .drift = {0.2, 0.05}};
    test::Bench bench(spec);
    const support::RtGuard guard;
    for (int i = 0; i < 3000; ++i) {
        DeviceReading reading{.X_BD = spec.parts[0].X_WP};
        reading.X_BD.p += Vec3(1e-3 * std::sin(0.01 * i), 0, 3e-3 * std::sin(0.02 * i));
        reading.buttons = i % 300 > 200 ? kClutch : i % 170 > 100 ? kScale : 0u;
        bench.step(reading);
    }
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

TEST(Navigation, OfAWrongValueIsRefused) {
    // Truth: the ranges of scene_spec.h.
    const auto refused = [](const scene::Navigation& navigation) {
        auto spec = alone();
        spec.effects.navigation = navigation;
        return spec.validate().size();
    };
    EXPECT_EQ(refused({}), 0u);
    EXPECT_EQ(refused({.clutch = {24, true}, .second_scale = {1, 5.0}, .drift = {0.5, 0.1}}), 0u);
    EXPECT_EQ(refused({.clutch = {25, true}}), 1u);
    EXPECT_EQ(refused({.clutch = {3, true}, .second_scale = {3, 1.0}}), 1u);
    EXPECT_EQ(refused({.second_scale = {3, 0.0}}), 1u);
    EXPECT_EQ(refused({.second_scale = {3, std::nan("")}}), 1u);
    EXPECT_EQ(refused({.drift = {0.51, 0.1}}), 1u);
    EXPECT_EQ(refused({.drift = {-0.1, 0.1}}), 1u);
    EXPECT_EQ(refused({.drift = {0.1, 0.0}}), 1u);
}

TEST(Navigation, AlongAPathOfThePartIsThatOfTheScene) {
    // Truth: closed form: a path of the held part in the world in place of the device's poses: the second scale is the
    // ratio, the drift's middle lies where the device's home is, in the scene's metres.
    auto spec = alone();
    spec.registration = {{rotationFromVector({0.3, -0.7, 0.4}), Vec3(0.1, -0.2, 0.3)}, 4.0, Pose{}};
    spec.effects.navigation = {.second_scale = {3, 0.5}, .drift = {0.2, 0.05, Vec3(0.01, 0, 0)}};
    auto dropped = spec;
    scene::dropRegistrations(dropped);
    test::Bench by_device(spec), by_path(dropped);
    for (int i = 0; i < 300; ++i) {
        DeviceReading reading{.X_BD = handleAt(i), .buttons = i > 100 && i < 200 ? kScale : 0u};
        const auto a = by_device.step(reading);
        reading.X_BD = tick::registeredPose(spec.registration, reading.X_BD, spec.registration.X_DH);
        const auto b = by_path.step(reading);
        EXPECT_LT(apart(a.frame.X_WH, b.frame.X_WH), 1e-13) << i;
    }
}

}  // namespace
}  // namespace passung
