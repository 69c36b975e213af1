#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "core/tick/god_object_heuristic.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

using model::ContactMethod;

constexpr double kCell = 0.5e-3;
const Pose kTableTop{Quat::Identity(), Vec3(0, 0, -0.02)};
const model::Shape kTable = model::Box{0.08, 0.08, 0.04};

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

test::Bench ballOverTable(double stiffness = 1000.0) {
    auto spec = test::scene(model::Sphere{0.02}, at(0, 0, 0.02), kTable, kTableTop, ContactMethod::GodObjectHeuristic);
    spec.contact.stiffness = stiffness;
    return test::Bench(spec);
}

TEST(GodObjectHeuristic, StaysOnPlaneWhenDevicePressesThrough) {
    // Truth: closed form. The ball's lowest point is its centre less its radius; overlap ≤ 5 % of the cell.
    test::Bench bench = ballOverTable();
    for (int i = 0; i <= 1000; ++i) {
        const double depth = -0.005 + 2e-5 * i;  // to 15 mm below the surface at 20 mm/s
        const auto out = bench.step(at(0.0003, -0.0002, 0.01 - depth));
        const double lowest = out.X_WG.p.z() - 0.01;
        EXPECT_GT(lowest, -0.05 * kCell) << "tick " << i;
        if (depth > 0.001) {
            EXPECT_LT(std::abs(lowest), 0.05 * kCell) << "tick " << i;
        }
    }
}

TEST(GodObjectHeuristic, PushesBackWithStiffnessTimesDepthAlongTheNormal) {
    // Truth: closed form. F = K h n on a plane, up to the overlap that the proxy keeps.
    test::Bench bench = ballOverTable(800.0);
    tick::TickOutput out;
    for (int i = 0; i < 400; ++i) out = bench.step(at(0, 0, 0.01 - std::min(0.004, 2e-5 * i)));
    EXPECT_NEAR(out.frame.F_H_W.force.z(), 800.0 * 0.004, 800.0 * 0.05 * kCell);
    EXPECT_LT(std::hypot(out.frame.F_H_W.force.x(), out.frame.F_H_W.force.y()), 1e-3 * out.frame.F_H_W.force.z());
}

TEST(GodObjectHeuristic, SlidesWithoutFrictionAlongAPlane) {
    // Truth: invariant. No effect of the scene brakes along the surface.
    test::Bench bench = ballOverTable();
    tick::TickOutput out;
    for (int i = 0; i < 300; ++i) out = bench.step(at(0, 0, 0.01 - std::min(0.003, 2e-5 * i)));
    for (int i = 0; i < 500; ++i) {
        out = bench.step(at(3e-5 * i, 1e-5 * i, 0.007));
        const Vec3 force = out.frame.F_H_W.force;
        EXPECT_LT(std::hypot(force.x(), force.y()), 0.01 * force.z()) << "tick " << i;
    }
    EXPECT_NEAR(out.X_WG.p.x(), 3e-5 * 499, 2e-5);
}

TEST(GodObjectHeuristic, FollowsTheHandExactlyInFreeMotion) {
    // Truth: invariant. Without contact G = H and the wrench is zero, at any speed.
    test::Bench bench = ballOverTable();
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Pose X{rotationFromVector(Vec3(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0)),
                     Vec3(random.uniform(-0.003, 0.003), random.uniform(-0.003, 0.003), random.uniform(0.02, 0.023))};
        const auto out = bench.step(X);
        EXPECT_LT((out.X_WG.p - X.p).norm(), 1e-12);
        EXPECT_EQ(out.frame.F_H_W.force.norm(), 0.0);
    }
}

TEST(GodObjectHeuristic, NeverLetsABallThroughAZeroThicknessSheet) {
    // Truth: closed form. The ball's centre stays a radius away from the sheet's plane, on its own side.
    auto spec = test::scene(model::Sphere{0.01}, at(0, 0, 0.02), model::Sheet{0.1, 0.1}, Pose{},
                            ContactMethod::GodObjectHeuristic);
    Random random(11);
    for (const double speed : {0.1, 0.5, 2.0}) {
        for (const double side : {1.0, -1.0}) {
            spec.parts[0].X_WP = at(0, 0, side * 0.02);
            test::Bench bench(spec);
            const Vec3 drift(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), -side);
            Vec3 hand(0, 0, side * 0.02);
            for (int i = 0; i < static_cast<int>(0.06 / (speed * 1e-3)); ++i) {
                hand += speed * 1e-3 * drift;
                const auto out = bench.step(Pose{Quat::Identity(), hand});
                ASSERT_GT(side * out.X_WG.p.z(), 0.005) << "speed " << speed << " tick " << i;
            }
        }
    }
}

TEST(GodObjectHeuristic, LeavesACornerForceAlongTheBisector) {
    // Truth: closed form. Two equal constraints: a ball pressed into the edge between a floor and a wall along the
    // bisector is pushed back along it. The scene is turned at random to show that the grid has no say.
    Random random(5);
    for (int trial = 0; trial < 5; ++trial) {
        const Quat turn = rotationFromVector(Vec3(random.normal(), random.normal(), random.normal()));
        auto spec = test::scene(model::Sphere{0.01}, {turn, turn * Vec3(0.012, 0, 0.012)}, model::Box{0.05, 0.05, 0.02},
                                {turn, turn * Vec3(0.025, 0, -0.01)}, ContactMethod::GodObjectHeuristic);
        spec.parts.push_back(
            {.name = "wall", .geometry = model::Box{0.02, 0.05, 0.05}, .X_WP = {turn, turn * Vec3(-0.01, 0, 0.02)}});
        test::Bench bench(spec);
        tick::TickOutput out;
        for (int i = 0; i < 600; ++i) {
            const double along = 0.012 - std::min(0.010, 2e-5 * i);
            out = bench.step(Pose{turn, turn * Vec3(along, 0, along)});
        }
        const Vec3 bisector = turn * Vec3(1, 0, 1).normalized();
        EXPECT_LT(std::acos(std::min(1.0, out.frame.F_H_W.force.normalized().dot(bisector))), 0.02);
        const Vec3 centre = turn.conjugate() * out.X_WG.p;
        EXPECT_GT(centre.x(), 0.005 - 0.05 * kCell);
        EXPECT_GT(centre.z(), 0.005 - 0.05 * kCell);
    }
}

TEST(GodObjectHeuristic, LeavesADeepOverlapWithoutAKick) {
    // Truth: invariant. Started 2 mm inside, the proxy comes out; no tick moves it by more than the step limits allow.
    auto spec = test::scene(model::Sphere{0.02}, at(0, 0, 0.008), kTable, kTableTop, ContactMethod::GodObjectHeuristic);
    test::Bench bench(spec);
    Pose last = at(0, 0, 0.008);
    tick::TickOutput out;
    for (int i = 0; i < 200; ++i) {
        out = bench.step(at(0, 0, 0.008));
        EXPECT_LT((out.X_WG.p - last.p).norm(), 0.004);
        last = out.X_WG;
    }
    EXPECT_GT(out.X_WG.p.z(), 0.01 - 0.05 * kCell);
}

}  // namespace
}  // namespace passung
