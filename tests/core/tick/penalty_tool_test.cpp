#include "core/tick/penalty_tool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/tick/god_object.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using scene::PenaltyCoupling;
using scene::PenaltyVariant;

constexpr double kStiffness = 2000, kContact = 6000, kTurn = 1.0;

/// `held` over a block whose top is z = 0, everything turned by `R`.
scene::SceneSpec overBlock(const shape::Shape& held, const Vec3& p, const Quat& R = Quat::Identity()) {
    auto spec = test::scene(held, {R, R * p}, shape::Box{0.08, 0.08, 0.04}, {R, R * Vec3(0, 0, -0.02)},
                            scene::ContactMethod::Penalty);
    spec.contact.coupling = PenaltyCoupling::QuasiStatic;
    spec.contact.stiffness = kStiffness;
    spec.contact.penalty_stiffness = kContact;
    spec.contact.rotational_stiffness = kTurn;
    return spec;
}

/// What is displayed when the hand has come from `from` to `to` in `ticks` and stays there for as many.
tick::TickOutput press(test::Bench& bench, const Pose& from, const Pose& to, int ticks) {
    tick::TickOutput out;
    for (int i = 1; i <= 2 * ticks; ++i) {
        const double s = std::min(1.0, static_cast<double>(i) / ticks);
        out = bench.step(Pose{from.q.slerp(s, to.q), from.p + s * (to.p - from.p)});
    }
    return out;
}

const Quat kTilted = rotationFromVector(Vec3(0.4, -1.1, 0.7));

TEST(PenaltyTool, ShowsSpringAndContactInSeriesOnAPlane) {
    // Truth: closed form. K (h - d) = k d, so that the hand feels K k/(K + k) h and the tool overlaps by d = K h/(K +
    // k).
    const double h = 2e-3;
    for (const auto coupling : {PenaltyCoupling::QuasiStatic, PenaltyCoupling::Virtual})
        for (const Quat& R : {Quat::Identity(), kTilted}) {
            auto spec = overBlock(shape::Sphere{0.02}, Vec3(0, 0, 0.0105), R);
            spec.contact.coupling = coupling;
            spec.contact.damping = 5;
            spec.contact.rotational_damping = 1e-3;
            test::Bench bench(spec);
            const auto out = press(bench, {R, R * Vec3(0, 0, 0.0105)}, {R, R * Vec3(0, 0, 0.01 - h)}, 400);
            const double series = kStiffness * kContact / (kStiffness + kContact) * h;
            EXPECT_NEAR((R.conjugate() * out.F_D_B.force).z(), series, 0.01 * series);
            EXPECT_LT((out.F_D_B.force - out.F_D_B.force.norm() * (R * Vec3::UnitZ())).norm(), 0.01 * series);
            EXPECT_NEAR(out.frame.proxy_depth, kStiffness * h / (kStiffness + kContact), 0.01 * h);
            EXPECT_NEAR(out.frame.hand_depth, h, 0.01 * h);
            EXPECT_EQ(out.frame.status & kIterationLimit, 0u);
        }
}

TEST(PenaltyTool, SlidesAsIfThePartsHadNoFriction) {
    // Truth: invariant: contacts of a penalty push along their normals alone, at the hand and on a tool.
    for (const auto coupling : {PenaltyCoupling::Direct, PenaltyCoupling::QuasiStatic, PenaltyCoupling::Virtual}) {
        tick::TickOutput out[2];
        for (const double friction : {0.0, 0.8}) {
            auto spec = overBlock(shape::Sphere{0.02}, Vec3(0, 0, 0.0105));
            spec.contact.coupling = coupling;
            for (scene::PartSpec& part : spec.parts) part.friction = part.sliding_friction = friction;
            test::Bench bench(spec);
            press(bench, {Quat::Identity(), Vec3(0, 0, 0.0105)}, {Quat::Identity(), Vec3(0, 0, 0.009)}, 200);
            out[friction > 0.0] =
                press(bench, {Quat::Identity(), Vec3(0, 0, 0.009)}, {Quat::Identity(), Vec3(0.005, 0, 0.009)}, 200);
        }
        EXPECT_GT(out[1].F_D_B.force.z(), 0.5);
        EXPECT_EQ(out[0].F_D_B.force, out[1].F_D_B.force);
    }
}

TEST(PenaltyTool, TurnsAgainstATiltedBoxLikeTwoSpringsInSeries) {
    // Truth: closed form. All of the box's foot a × b is in: F = κ a b d; its tilt is a ship's, T = (κ a³ b/12 - F e) θ
    // with e the height of the box's centre above that of its immersed part.
    const double a = 0.02, b = 0.016, height = 0.01, kappa = 2e7;
    const Vec3 start(0, 0, height / 2 + 1e-3);
    auto spec = overBlock(shape::Box{a, b, height}, start);
    spec.contact.variant = PenaltyVariant::AreaWeighted;
    spec.contact.area_stiffness = kappa;
    test::Bench bench(spec);
    const double h = 1.5e-3, tilt = 0.03;
    const Quat turned = rotationFromVector(Vec3(0, tilt, 0));
    const auto out = press(bench, {Quat::Identity(), start}, {turned, Vec3(0, 0, height / 2 - h)}, 400);
    const double k = kappa * a * b, force = kStiffness * k / (kStiffness + k) * h;
    const double k_turn = kappa * a * a * a * b / 12 - force * (height - force / k) / 2;
    const double torque = kTurn * k_turn / (kTurn + k_turn) * tilt;
    EXPECT_NEAR(out.F_D_B.force.z(), force, 0.01 * force);
    EXPECT_NEAR(-out.F_D_B.torque.y(), torque, 0.01 * torque);
}

TEST(PenaltyTool, RestsInACornerWhereEachWallBalancesItsPartOfTheSpring) {
    // Truth: closed form. Area-weighted, a ball pushed into two walls: per wall K (h - d) = κ π d² (R - d/3), the cap
    // under it; the walls are at right angles and far from each other's caps.
    const double radius = 0.01, kappa = 2e7;
    auto spec = overBlock(shape::Sphere{2 * radius}, Vec3(0, 0, 0.0105));
    spec.parts.push_back({.name = "wall",
                          .geometry = shape::Shape(shape::Box{0.02, 0.08, 0.04}),
                          .X_WP = {Quat::Identity(), Vec3(0.0205, 0, 0.0205)}});  // its face: x = 10.5 mm
    spec.contact.spacing = 0.25e-3;
    spec.contact.variant = PenaltyVariant::AreaWeighted;
    spec.contact.area_stiffness = kappa;
    test::Bench bench(spec);
    const double h_x = 2e-3, h_z = 1e-3;
    const auto out = press(bench, {Quat::Identity(), Vec3(0, 0, 0.0105)},
                           {Quat::Identity(), Vec3(0.0105 - radius + h_x, 0, radius - h_z)}, 400);
    const auto balanced = [&](double h) {
        double low = 0, high = h;
        for (int i = 0; i < 60; ++i) {
            const double d = 0.5 * (low + high);
            (kStiffness * (h - d) > kappa * std::numbers::pi * d * d * (radius - d / 3) ? low : high) = d;
        }
        return kStiffness * (h - low);
    };
    const Vec3 truth(-balanced(h_x), 0, balanced(h_z));
    EXPECT_LT((out.F_D_B.force - truth).norm(), 0.01 * truth.norm());
    EXPECT_LT(out.F_D_B.force.normalized().cross(truth.normalized()).norm(), 0.5 * std::numbers::pi / 180);
}

TEST(PenaltyTool, IsTheGodObjectWhereContactsAreHard) {
    // Truth: closed form. k → ∞: the tool stays on the plane and the spring has all of the depth.
    auto spec = overBlock(shape::Box{0.02, 0.016, 0.01}, Vec3(0, 0, 0.006));
    spec.contact.penalty_stiffness = 1e8;
    for (const auto variant : {PenaltyVariant::MaxNormalised, PenaltyVariant::Raw}) {
        spec.contact.variant = variant;
        test::Bench bench(spec);
        const auto out =
            press(bench, {Quat::Identity(), Vec3(0, 0, 0.006)}, {Quat::Identity(), Vec3(0.002, 0, 0.003)}, 200);
        EXPECT_NEAR(out.F_D_B.force.z(), kStiffness * 2e-3, 1e-3 * kStiffness * 2e-3);
        EXPECT_LT(out.frame.proxy_depth, 1e-7);
        EXPECT_EQ(out.frame.status & kIterationLimit, 0u);
    }
}

TEST(PenaltyTool, IsTheDirectPenaltyWhereTheCouplingIsHard) {
    // Truth: the direct penalty of the same scene, itself held against closed forms (penalty_truth_test). K → ∞: the
    // tool is at the hand; 1.5 %, for K is 200 times the contacts' stiffness.
    const Pose X_WH{rotationFromVector(Vec3(0.05, 0.08, 0)), Vec3(0.001, 0, 0.0045)};
    for (const auto variant : {PenaltyVariant::MaxNormalised, PenaltyVariant::AreaWeighted, PenaltyVariant::Raw}) {
        auto spec = overBlock(shape::Box{0.02, 0.016, 0.01}, X_WH.p);
        spec.parts[0].X_WP = X_WH;
        spec.contact.variant = variant;
        spec.contact.area_stiffness = 1e7;
        spec.contact.stiffness = 1e6;
        spec.contact.rotational_stiffness = 100;
        spec.contact.penalty_stiffness = variant == PenaltyVariant::Raw ? 20 : 5000;
        test::Bench coupled(spec);
        spec.contact.coupling = PenaltyCoupling::Direct;
        spec.contact.stiffness = spec.contact.penalty_stiffness;
        test::Bench direct(spec);
        tick::TickOutput out;
        for (int i = 0; i < 20; ++i) out = coupled.step(X_WH);
        const auto truth = direct.step(X_WH);
        EXPECT_LT((out.F_D_B.force - truth.F_D_B.force).norm(), 0.015 * truth.F_D_B.force.norm());
        EXPECT_LT((out.F_D_B.torque - truth.F_D_B.torque).norm(), 0.015 * truth.F_D_B.torque.norm());
    }
}

/// Energy that the hand puts into a closed path in the plane of x and z that presses, slides and turns.
struct Cycle {
    double given = 0, most = 0;
};
Cycle around(scene::SceneSpec spec) {
    test::Bench bench(spec);
    const int ticks = 4000;
    const auto at = [&](int i) {
        const double s = 2 * std::numbers::pi * i / ticks;
        return Pose{rotationFromVector(Vec3(0.02 * std::sin(s), 0.03 * std::sin(2 * s), 0)),
                    Vec3(0.004 * std::sin(s), 0.002 * std::sin(2 * s), 0.0045 + 1e-3 * std::cos(s))};
    };
    Cycle cycle;
    Wrench before;
    for (int i = -ticks; i <= ticks; ++i) {  // once around to begin where it ends
        const auto out = bench.step(at(i));
        if (i > 0) {
            const Pose X = at(i), Y = at(i - 1);
            cycle.given -= 0.5 * (out.F_D_B.force + before.force).dot(X.p - Y.p) +
                           0.5 * (out.F_D_B.torque + before.torque).dot(rotationVector(X.q * Y.q.conjugate()));
            cycle.most = std::max(cycle.most, std::abs(cycle.given));
        }
        before = out.F_D_B;
    }
    return cycle;
}

TEST(PenaltyTool, CostsNoEnergyAroundAClosedSlowPath) {
    // Truth: invariant. Without mass, damper and friction: what is put in comes out. 1 % of the most that was stored:
    // the penalty sums over points in place of a surface, so that it has an energy only nearly.
    auto spec = overBlock(shape::Box{0.02, 0.016, 0.01}, Vec3(0, 0, 0.0055));
    spec.contact.spacing = 0.5e-3;
    spec.contact.variant = PenaltyVariant::AreaWeighted;
    spec.contact.area_stiffness = 2e7;
    const Cycle cycle = around(spec);
    EXPECT_GT(cycle.most, 1e-4);
    EXPECT_LT(std::abs(cycle.given), 0.01 * cycle.most);
}

TEST(PenaltyTool, LeavesDeepOverlapWithoutAKick) {
    // Truth: invariant. 3 mm deep at the start: the force rises by no more than K kRepair cells a tick, and the tool
    // moves no faster; it ends where spring and contact balance.
    for (const auto coupling : {PenaltyCoupling::QuasiStatic, PenaltyCoupling::Virtual}) {
        auto spec = overBlock(shape::Sphere{0.02}, Vec3(0, 0, 0.007));
        spec.contact.coupling = coupling;
        spec.contact.penalty_stiffness = 20 * kStiffness;
        test::Bench bench(spec);
        const double most = tick::kRepair * bench.model().finest_cell;
        double last = 0, height = 0.007, fastest = 0;
        for (int i = 0; i < 2000; ++i) {
            const auto out = bench.step(Pose{Quat::Identity(), Vec3(0, 0, 0.007)});
            const double force = out.F_D_B.force.norm();
            ASSERT_LE(force - last, 1.01 * kStiffness * most) << i;
            fastest = std::max(fastest, std::abs(out.X_WG.p.z() - height));
            height = out.X_WG.p.z();
            last = force;
        }
        EXPECT_LE(fastest, 1.01 * most);
        EXPECT_NEAR(last, kStiffness * 3e-3 * 20 / 21, 0.01 * last);
    }
}

TEST(PenaltyTool, FollowsAFreeHandWhereverItGoes) {
    // Truth: closed form. Without contact the tool without mass is where the hand is, at 2 m/s and 20 rad/s too, and
    // there is no force; also beside the block, whose top it nearly touches.
    auto spec = overBlock(shape::Box{0.02, 0.016, 0.01}, Vec3(0, 0, 0.0052));
    test::Bench bench(spec);
    for (int i = 0; i < 200; ++i) {
        const double t = i * kTickSeconds;
        const Pose X_WH{rotationFromVector(Vec3(0, 0, 20 * t)), Vec3(2 * t, 0, 0.0052 + 0.1 * t)};
        const auto out = bench.step(X_WH);
        ASSERT_LT((out.X_WG.p - X_WH.p).norm(), 1e-7) << i;
        ASSERT_LT(out.F_D_B.force.norm(), 1e-4) << i;
        ASSERT_EQ(out.frame.status & kIterationLimit, 0u) << i;
    }
}

TEST(PenaltyTool, SharesItsForceAmongObstaclesAndBooksIt) {
    // Truth: invariant. The pushes of obstacles and of nobody add up to the wrench on the hand.
    auto spec = overBlock(shape::Sphere{0.02}, Vec3(0, 0, 0.0105));
    spec.parts.push_back({.name = "wall",
                          .geometry = shape::Shape(shape::Box{0.02, 0.08, 0.04}),
                          .X_WP = {Quat::Identity(), Vec3(0.0205, 0, 0.0205)}});
    spec.contact.variant = PenaltyVariant::Raw;
    test::Bench bench(spec);
    const auto out =
        press(bench, {Quat::Identity(), Vec3(0, 0, 0.0105)}, {Quat::Identity(), Vec3(0.002, 0, 0.009)}, 300);
    const auto& pushes = bench.state().pushes;
    ASSERT_EQ(pushes.size(), 3u);
    EXPECT_NEAR(pushes[0].wrench.force.z(), out.F_D_B.force.z(), 0.01 * out.F_D_B.force.norm());
    EXPECT_NEAR(pushes[1].wrench.force.x(), out.F_D_B.force.x(), 0.01 * out.F_D_B.force.norm());
    EXPECT_LT((pushes[0].wrench.force + pushes[1].wrench.force + pushes[2].wrench.force - out.F_D_B.force).norm(),
              1e-9);
}

TEST(PenaltyTool, WithMassSwingsLikeAMassOnASpringAndDamper) {
    // Truth: closed form. The hand jumps by 1 mm in free room, which is a step of spring and damper: with ω² = K/m,
    // 2 ζ ω = B/m and s = h - x, s'' + 2ζω s' + ω² s = 0 from s = h(1 - dt B/m ...) on. 3 % of the jump: the implicit
    // rule is of first order, ω T = 0.02.
    auto spec = overBlock(shape::Sphere{0.02}, Vec3(0, 0, 0.05));
    spec.contact.coupling = PenaltyCoupling::Virtual;
    spec.contact.stiffness = 200;
    spec.contact.rotational_stiffness = 0.2;
    spec.contact.tool_mass = 0.5;
    spec.contact.tool_inertia = 5e-4;
    spec.contact.damping = 0;
    test::Bench bench(spec);
    const double jump = 1e-3, w = std::sqrt(200 / 0.5);
    bench.step(Pose{Quat::Identity(), Vec3(0, 0, 0.05)});
    const Quat turned = rotationFromVector(Vec3(0, 0, 0.1));
    double farthest = 0;
    for (int i = 1; i <= 400; ++i) {
        const auto out = bench.step(Pose{turned, Vec3(0, 0, 0.05 + jump)});
        const double t = i * kTickSeconds, decay = std::exp(-0.5 * w * w * kTickSeconds * t);  // of the rule itself
        const double truth = 1 - decay * std::cos(w * t);
        farthest = std::max(farthest, std::abs((out.X_WG.p.z() - 0.05) / jump - truth));
        EXPECT_NEAR(rotationVector(out.X_WG.q).z() / 0.1, truth, 0.03) << i;
    }
    EXPECT_LT(farthest, 0.03);
}

TEST(PenaltyTool, WithMassComesToRestAndStaysThere) {
    // Truth: invariant. Energy of mass, spring and contact, once the hand stands: never more than the tick before, for
    // 100 000 ticks of a box pressed tilted onto the block; then none is left in motion.
    auto spec = overBlock(shape::Box{0.02, 0.016, 0.01}, Vec3(0, 0, 0.006));
    spec.contact.coupling = PenaltyCoupling::Virtual;
    spec.contact.damping = 1;
    spec.contact.rotational_damping = 1e-4;
    spec.contact.tool_mass = 0.2;
    spec.contact.tool_inertia = 2e-4;
    test::Bench bench(spec);
    const Pose down{rotationFromVector(Vec3(0.02, 0.03, 0)), Vec3(0.001, 0, 0.0042)};
    for (int i = 0; i < 100; ++i)
        bench.step(Pose{Quat::Identity().slerp(i / 100.0, down.q),
                        Vec3(0, 0, 0.006) + i / 100.0 * (down.p - Vec3(0, 0, 0.006))});
    Pose last = bench.step(down).X_WG;
    double moved = 0, settled = 0;
    for (int i = 0; i < 100000; ++i) {
        const Pose X = bench.step(down).X_WG;
        const double way = (X.p - last.p).norm() + 0.01 * rotationVector(X.q * last.q.conjugate()).norm();
        last = X;
        if (i == 2000) settled = way;
        if (i > 2000) moved = std::max(moved, way);
    }
    EXPECT_LT(settled, 1e-8);
    EXPECT_LT(moved, 1e-8);
}

}  // namespace
}  // namespace passung
