#include "core/tick/snap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

// Near its place a held part is drawn into it.

namespace passung {
namespace {

constexpr double kStiffness = 600.0, kRange = 0.008;  // [N/m], [m]
constexpr double kRadius = 0.03;                      // [m]: a turn of 1 rad is as far
const Pose kPlace{rotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0.02, -0.01, 0.03)};

/// A ball in the air, with a place.
scene::SceneSpec ballWithPlace(double stiffness) {
    scene::SceneSpec spec = test::scene(shape::Sphere{0.01}, Pose{}, shape::Box{0.06, 0.06, 0.02},
                                        Pose{Quat::Identity(), {0, 0, -1}}, scene::ContactMethod::GodObject);
    spec.parts.resize(1);
    spec.contact.stiffness = 1000.0;
    spec.contact.rotational_stiffness = 1000.0 * kRadius * kRadius;
    spec.effects.snap = {.stiffness = stiffness, .range = kRange, .X_WG = {kPlace}};
    return spec;
}

/// What the stage adds at a pose of the hand that holds `p_GC`, parts at rest where they begin.
Wrench drawnAt(const tick::HandModel& model, const Pose& X_WH, const Vec3& p_GC = Vec3::Zero()) {
    tick::HandSample hand;
    hand.X_WH = X_WH;
    hand.input_usable = true;
    tick::ObstaclePoses obstacles;
    for (const tick::Obstacle& obstacle : model.obstacles)
        obstacles.X_WO.push_back(model.bodies[obstacle.body].X_WP_start);
    tick::Grip grip;
    grip.p_GC = p_GC;
    tick::SnapShare added;
    tick::drawIntoPlace(model, hand, grip, obstacles, added);
    return added.of_snap;
}

/// Moved from the place by `away` and turned by `turn`, world axes.
Pose besidePlace(const Vec3& away, const Vec3& turn) { return {rotationFromVector(turn) * kPlace.q, kPlace.p + away}; }

TEST(Snap, WithAStiffnessOfZeroIsNoneToTheLastBit) {
    // Truth: invariant: the hash over all outputs, beside a scene that does not name it.
    auto none = ballWithPlace(0.0);
    none.effects.snap = {};
    test::Bench a(none), b(ballWithPlace(0.0));
    for (int i = 0; i < 1000; ++i) {
        const Pose X{Quat::Identity(), Vec3(2e-5 * i, -1e-5 * i, 3e-5 * i)};
        a.step(X);
        b.step(X);
        ASSERT_EQ(a.wholeState().hash, b.wholeState().hash) << i;
    }
    for (const tick::Stage& stage : b.model().stages) EXPECT_STRNE(stage.name, "snap");
}

TEST(Snap, DrawsAsTheFormulaSaysAndNotFromTheRangeOn) {
    // Truth: closed form of the head comment, evaluated here by hand: at half the range (3/4)² = 9/16 of the spring.
    test::Bench bench(ballWithPlace(kStiffness));
    const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
    const auto near = [](const Wrench& is, const Vec3& force, const Vec3& torque) {
        return (is.force - force).norm() < 1e-9 && (is.torque - torque).norm() < 1e-11;
    };
    const auto at = [&](const Vec3& away, const Vec3& turn) { return drawnAt(bench.model(), besidePlace(away, turn)); };
    EXPECT_TRUE(near(at(Vec3::Zero(), Vec3::Zero()), Vec3::Zero(), Vec3::Zero()));
    EXPECT_TRUE(near(at(0.004 * x, Vec3::Zero()), -600.0 * 9 / 16 * 0.004 * x, Vec3::Zero()));
    EXPECT_TRUE(near(at(Vec3::Zero(), 0.004 / 0.03 * z), Vec3::Zero(), -600.0 * 9 / 16 * 0.004 * 0.03 * z));
    // 3-4-5: 2.4 mm and a turn that counts 3.2 mm are 4 mm together.
    EXPECT_TRUE(
        near(at(0.0024 * x, 0.0032 / 0.03 * z), -600.0 * 9 / 16 * 0.0024 * x, -600.0 * 9 / 16 * 0.0032 * 0.03 * z));
    // The largest force: 0.286 K r = 1.374 N, at r/√5.
    double most = 0.0;
    for (double d = 0.0; d <= kRange; d += 1e-6) most = std::max(most, at(d * x, Vec3::Zero()).force.norm());
    EXPECT_NEAR(most, 16.0 / (25.0 * std::sqrt(5.0)) * 600.0 * 0.008, 1e-6);
    EXPECT_NEAR(at(kRange / std::sqrt(5.0) * x, Vec3::Zero()).force.norm(), most, 1e-6);
    for (const double beyond : {1.0000001, 1.5, 20.0}) {
        const Wrench none = at(beyond * kRange * x, Vec3::Zero());
        EXPECT_EQ(none.force, Vec3::Zero()) << beyond;
        EXPECT_EQ(none.torque, Vec3::Zero()) << beyond;
    }
}

TEST(Snap, GivesOnTheWayInWhatItTakesOnTheWayOut) {
    // Truth: energy, summed here along ways of 20 000 steps at their middles: K r²/6 from far outside to the place, and
    // none on a closed way through position and turn. The second is checked to be no trivial one by its largest part.
    test::Bench bench(ballWithPlace(kStiffness));
    const auto work = [&](const auto& pose, double from, double to) {
        constexpr int kSteps = 20000;
        double sum = 0.0, most = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double h = (to - from) / kSteps;
            const Pose a = pose(from + i * h), middle = pose(from + (i + 0.5) * h), b = pose(from + (i + 1) * h);
            const Wrench w = drawnAt(bench.model(), middle);
            sum += w.force.dot(b.p - a.p) + w.torque.dot(rotationVector(b.q * a.q.conjugate()));
            most = std::max(most, std::abs(sum));
        }
        return std::pair(sum, most);
    };
    const auto in = [](double t) {
        return besidePlace((1.0 - t) * Vec3(0.012, -0.006, 0.004), (1.0 - t) * Vec3(0.1, 0.3, -0.2));
    };
    EXPECT_NEAR(work(in, 0.0, 1.0).first, kStiffness * kRange * kRange / 6.0, 1e-8);
    const auto round = [](double t) {
        return besidePlace(0.004 * Vec3(std::cos(t), std::sin(2 * t), 0.5 * std::sin(t)),
                           0.1 * Vec3(std::sin(t), std::cos(3 * t), std::sin(2 * t)));
    };
    const auto [left, most] = work(round, 0.0, 2.0 * std::numbers::pi);
    EXPECT_GT(most, 1e-3);
    EXPECT_LT(std::abs(left), 1e-8);
}

TEST(Snap, CatchesWhatComesWithinTheRangeAndLeavesTheRestAlone) {
    // Truth: invariant, of a mass behind a damper, integrated here: what starts within the range ends in the place,
    // what starts outside never moves.
    const auto rest = [](const Vec3& away) {
        test::Bench bench(ballWithPlace(kStiffness));
        constexpr double kMass = 0.3, kDrag = 8.0;
        Vec3 x = kPlace.p + away, v = Vec3::Zero();
        for (int i = 0; i < 3000; ++i) {
            const Vec3 force = bench.step(Pose{kPlace.q, x}).frame.F_H_W.force;
            v += kTickSeconds / kMass * (force - kDrag * v);
            x += kTickSeconds * v;
        }
        return Vec3(x - kPlace.p);
    };
    EXPECT_LT(rest(Vec3(0.0, 0.9 * kRange, 0.0)).norm(), 1e-5);
    EXPECT_LT(rest(Vec3(0.3 * kRange, 0.0, -0.5 * kRange)).norm(), 1e-5);
    EXPECT_EQ(rest(Vec3(0.0, 1.1 * kRange, 0.0)), Vec3(kPlace.p + Vec3(0.0, 1.1 * kRange, 0.0) - kPlace.p));
}

/// A pin that is picked up and belongs on a plate, there and, with `folds`, turned.
scene::SceneSpec pinAndPlate(int folds) {
    auto spec =
        test::scene(shape::Sphere{0.005}, Pose{Quat::Identity(), Vec3(0, 0, 0.1)}, shape::Box{0.03, 0.03, 0.01},
                    Pose{rotationFromVector(Vec3(0, 0.4, 0)), Vec3(0.05, 0, 0)}, scene::ContactMethod::GodObject);
    spec.contact.rotational_stiffness = spec.contact.stiffness * kRadius * kRadius;
    for (scene::PartSpec& part : spec.parts) part.pickable = part.held;
    spec.effects.pick.reach = 0.05;
    spec.effects.pick.steps = {
        {.part = 0, .into = 1, .X_IGoal = {Quat::Identity(), Vec3(0.0, 0.0, 0.02)}, .folds = folds}};
    spec.effects.snap = {.stiffness = kStiffness, .range = kRange};
    return spec;
}

TEST(Snap, DrawsAPickedPartToWhereItsStepSaysInTheFrameOfTheOther) {
    // Truth: closed form: the goal is 20 mm along the plate's own z axis; a turn about the part's z axis counts only up
    // to the nearest pose that looks alike.
    for (const int folds : {0, 1, 4}) {
        SCOPED_TRACE(folds);
        test::Bench bench(pinAndPlate(folds));
        const Quat R = rotationFromVector(Vec3(0, 0.4, 0));
        const Vec3 goal = Vec3(0.05, 0, 0) + 0.02 * (R * Vec3::UnitZ());
        const auto turned = [&](double about_z, const Vec3& away) {
            return drawnAt(bench.model(), {R * rotationFromVector(about_z * Vec3::UnitZ()), Vec3(goal + away)});
        };
        const Wrench aside = turned(0.0, Vec3(0, 0.004, 0));
        EXPECT_LT((aside.force - Vec3(0, -600.0 * 9 / 16 * 0.004, 0)).norm(), 1e-9);
        EXPECT_LT(aside.torque.norm(), 1e-12);
        // A quarter turn and 0.1 rad: 3 mm of the metric's from the nearest of four, far from the one, none of any.
        const Wrench quarter = turned(std::numbers::pi / 2 + 0.1, Vec3::Zero());
        EXPECT_LT(quarter.force.norm(), 1e-12);
        const double left = 1.0 - 0.003 * 0.003 / (kRange * kRange);
        const double torque = folds == 4 ? 600.0 * kRadius * kRadius * left * left * 0.1 : 0.0;
        EXPECT_LT((quarter.torque + torque * (R * Vec3::UnitZ())).norm(), 1e-9);
        // Tilted by 0.1 rad about its own x axis, which all of them see, turned by a full fold first or not.
        const double tilted = 600.0 * kRadius * kRadius * left * left * 0.1;
        for (const double about_z : {0.0, std::numbers::pi / 2}) {
            if (folds == 1 && about_z > 0.0) continue;
            const Quat lying = R * rotationFromVector(about_z * Vec3::UnitZ());
            const Quat q = lying * rotationFromVector(0.1 * Vec3::UnitX());
            const Wrench tilt = drawnAt(bench.model(), {q, goal});
            EXPECT_LT(tilt.force.norm(), 1e-12);
            EXPECT_LT((tilt.torque + tilted * (lying * Vec3::UnitX())).norm(), 1e-9) << about_z;
        }
    }
}

TEST(Snap, OfAPartThatIsHeldAsideHasThePotentialOfTheHoldsPoint) {
    // Truth: energy: none on a closed way, with the part held 40 mm from its origin, whatever its symmetry; near the
    // place it is no stiffer against turning about the hold than K ρ², but for the hold's distance from a round
    // part's axis.
    const Vec3 p_GC(0.012, -0.005, 0.04);
    const Quat R = rotationFromVector(Vec3(0, 0.4, 0));
    const Vec3 goal = Vec3(0.05, 0, 0) + 0.02 * (R * Vec3::UnitZ());
    for (const int folds : {0, 1, 4}) {
        SCOPED_TRACE(folds);
        test::Bench bench(pinAndPlate(folds));
        const auto pose = [&](double t) {
            const Vec3 turn = 0.05 * Vec3(std::sin(t), std::cos(3 * t), std::sin(2 * t));
            return Pose{rotationFromVector(turn) * R,
                        goal + 0.002 * Vec3(std::cos(t), std::sin(2 * t), 0.5 * std::sin(t))};
        };
        constexpr int kSteps = 20000;
        const double h = 2.0 * std::numbers::pi / kSteps;
        double sum = 0.0, most = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const Pose a = pose(i * h), b = pose((i + 1) * h);
            const Wrench w = drawnAt(bench.model(), pose((i + 0.5) * h), p_GC);
            sum += w.force.dot(b.p - a.p) + w.torque.dot(rotationVector(b.q * a.q.conjugate()));
            most = std::max(most, std::abs(sum));
        }
        EXPECT_GT(most, 1e-4);
        EXPECT_LT(std::abs(sum), 1e-8);
        // Turned about the hold by a little.
        const Vec3 hold = goal + R * p_GC;
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
            constexpr double kTurn = 1e-4;
            const Quat q = rotationFromVector(kTurn * axis) * R;
            const Wrench w = drawnAt(bench.model(), {q, hold - q * p_GC}, p_GC);
            const double about_hold = std::abs((w.torque - (q * p_GC).cross(w.force)).dot(axis)) / kTurn;
            const double aside = folds == 0 ? std::hypot(p_GC.x(), p_GC.y()) : 0.0;
            EXPECT_LT(about_hold, kStiffness * (kRadius * kRadius + aside * aside) * 1.001);
        }
    }
}

TEST(Snap, IsOfTheDeclaredTick) {
    // Truth: invariant: no memory, no lock; says that the force is none of contact.
    test::Bench bench(ballWithPlace(kStiffness));
    if (!support::RtGuard::available()) GTEST_SKIP();
    const support::RtGuard guard;
    const auto out = bench.step(besidePlace(Vec3(0.001, 0, 0), Vec3::Zero()));
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
    EXPECT_NE(out.frame.status & kAidedInAir, 0u);
    EXPECT_GT(out.frame.F_H_W.force.norm(), 0.1);
}

}  // namespace
}  // namespace passung
