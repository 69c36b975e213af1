#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/scene/contact_geometry.h"
#include "tests/support/scenes.h"

namespace passung {
namespace {

constexpr double kAtRest = 0.4, kSliding = 0.3;

/// A body over a plate whose top is z = 0, tilted as a whole by `world`.
scene::SceneSpec onPlate(scene::Geometry geometry, const shape::Shape& held, double height,
                         const Pose& world = Pose{}) {
    scene::SceneSpec spec =
        test::scene(held, world * Pose{Quat::Identity(), {0, 0, height}}, shape::Box{0.1, 0.1, 0.02},
                    world * Pose{Quat::Identity(), {0, 0, -0.01}}, scene::ContactMethod::GodObjectHeuristic);
    spec.contact.geometry = geometry;
    spec.contact.stiffness = 1000.0;
    spec.contact.rotational_stiffness = 2.0;
    for (auto& part : spec.parts) {
        part.friction = kAtRest;
        part.sliding_friction = kSliding;
    }
    return spec;
}

class FrictionInTheTick : public testing::TestWithParam<scene::Geometry> {};

INSTANTIATE_TEST_SUITE_P(From, FrictionInTheTick, testing::Values(scene::Geometry::Field, scene::Geometry::Surface),
                         [](const auto& made) { return std::string(scene::geometryName(made.param)); });

const Pose kTilted{Quat(Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized())), {0.03, -0.01, 0.02}};

TEST_P(FrictionInTheTick, KeepsTheConeAtRestAndInSlip) {
    // Truth: closed form (A10): |F_t| grows to μ_s F_n before the proxy moves, and is μ_d F_n while it slides; mark 1
    // %. A block on a plate, straight and turned; pressed by 1 mm and dragged by 1 µm a tick.
    for (const Pose& world : {Pose{}, kTilted}) {
        auto spec = onPlate(GetParam(), shape::Box{0.02, 0.02, 0.01}, 0.005, world);
        test::Bench bench(spec);
        Pose X = spec.parts[0].X_WP;
        const Vec3 n = world.q * Vec3::UnitZ(), t = world.q * Vec3(0.8, 0.6, 0.0);
        for (int i = 0; i < 200; ++i) {
            X.p -= 5e-6 * n;
            bench.step(X);
        }
        const Vec3 start = bench.step(X).X_WG.p;
        double most_at_rest = 0.0, least_slip = 1e9, most_slip = 0.0;
        for (int i = 0; i < 2000; ++i) {
            X.p += 1e-6 * t;
            const auto out = bench.step(X);
            const double normal = out.frame.F_H_W.force.dot(n);
            const double share = (out.frame.F_H_W.force - normal * n).norm() / normal;
            const double moved = (out.X_WG.p - start).dot(t);
            if (moved < 1e-9) {
                most_at_rest = std::max(most_at_rest, share);
            } else if (i > 1000) {
                least_slip = std::min(least_slip, share);
                most_slip = std::max(most_slip, share);
            }
        }
        std::printf("at rest up to %.4f (%.2f), sliding %.4f to %.4f (%.2f)\n", most_at_rest, kAtRest, least_slip,
                    most_slip, kSliding);
        EXPECT_NEAR(most_at_rest, kAtRest, 0.01 * kAtRest);
        EXPECT_NEAR(least_slip, kSliding, 0.01 * kSliding);
        EXPECT_NEAR(most_slip, kSliding, 0.01 * kSliding);
    }
}

TEST_P(FrictionInTheTick, HoldsATurnedDiscByTwoThirds) {
    // Truth: closed form (A10): T = 2/3 μ_d F_n R in slip; mark 5 %.
    constexpr double R = 0.01;
    for (const Pose& world : {Pose{}, kTilted}) {
        auto spec = onPlate(GetParam(), shape::Cylinder{2 * R, 0.02}, 0.01, world);
        test::Bench bench(spec);
        Pose X = spec.parts[0].X_WP;
        const Vec3 n = world.q * Vec3::UnitZ();
        for (int i = 0; i < 200; ++i) {
            X.p -= 5e-6 * n;
            bench.step(X);
        }
        double torque = 0.0, normal = 0.0;
        for (int i = 0; i < 600; ++i) {
            X.q = (rotationFromVector(1e-5 * n) * X.q).normalized();
            const auto out = bench.step(X);
            torque = out.frame.F_H_W.torque.dot(n);
            normal = out.frame.F_H_W.force.dot(n);
        }
        const double expected = 2.0 / 3.0 * kSliding * normal * R;
        std::printf("torque %.5f N m, expected %.5f\n", std::abs(torque), expected);
        EXPECT_NEAR(std::abs(torque), expected, 0.05 * expected);
        EXPECT_LT(torque, 0.0);
    }
}

TEST_P(FrictionInTheTick, DoesNotCreepAtRestNorKnowFrictionWhereNoneIsNamed) {
    // Truth: invariant. Within the cone the proxy stays where it is; with one smooth side it slides at once.
    auto spec = onPlate(GetParam(), shape::Box{0.02, 0.02, 0.01}, 0.005, kTilted);
    const Vec3 n = kTilted.q * Vec3::UnitZ(), t = kTilted.q * Vec3::UnitX();
    Pose X = spec.parts[0].X_WP;
    X.p += -1e-3 * n + 0.2e-3 * t;
    test::Bench rough(spec);
    for (int i = 0; i < 500; ++i) rough.step(X);
    const Vec3 there = rough.step(X).X_WG.p;
    for (int i = 0; i < 5000; ++i) rough.step(X);
    EXPECT_LT((rough.step(X).X_WG.p - there).norm(), 1e-9);
    spec.parts[1].friction = spec.parts[1].sliding_friction = 0.0;
    test::Bench smooth(spec);
    EXPECT_TRUE(smooth.model().friction.empty());
    tick::TickOutput out;
    for (int i = 0; i < 500; ++i) out = smooth.step(X);
    EXPECT_NEAR(out.frame.F_H_W.force.dot(t), 0.0, 1e-6);
}

}  // namespace
}  // namespace passung
