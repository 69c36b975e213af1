#include "core/tick/closed_form_proxy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung::tick {
namespace {

using scene::ContactMethod;

constexpr double kOverlap = 1e-7;      // [m] that a proxy may keep
constexpr double kStiffness = 2000.0;  // [N/m]

scene::SceneSpec closedFormScene(const shape::Shape& held, const Pose& X_WHeld, const shape::Shape& fixed,
                                 const Pose& X_WFixed, ContactMethod method = ContactMethod::GodObject) {
    auto spec = test::scene(held, X_WHeld, fixed, X_WFixed, method);
    spec.contact.geometry = scene::Geometry::ClosedForm;
    spec.contact.stiffness = kStiffness;
    return spec;
}

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

/// A block of 10 mm over a table whose top is z = 0.
scene::SceneSpec blockOnTable(ContactMethod method) {
    return closedFormScene(shape::Box{0.02, 0.02, 0.01}, at(0, 0, 0.0052), shape::Box{0.06, 0.06, 0.02},
                           at(0, 0, -0.01), method);
}

constexpr std::array kMethods{ContactMethod::GodObject, ContactMethod::GodObjectHeuristic};

TEST(ClosedFormProxy, RestsOnAPlaneAndPushesWithTheSpring) {
    // Truth: closed form: the hand 2 mm below the plane, K times that, nothing along it; depth of the hand 2 mm.
    for (const ContactMethod method : kMethods) {
        test::Bench bench(blockOnTable(method));
        TickOutput out;
        for (int i = 0; i <= 120; ++i) out = bench.step(at(0.001, 0.0, 0.0052 - 2.2e-5 * std::min(i, 100)));
        EXPECT_NEAR(out.X_WG.p.z(), 0.005, kOverlap);
        EXPECT_NEAR(out.X_WG.p.x(), 0.001, 1e-9);
        EXPECT_NEAR((out.F_D_B.force - Vec3(0, 0, kStiffness * 0.002)).norm(), 0.0, kStiffness * kOverlap);
        EXPECT_LE(out.frame.proxy_depth, kOverlap);
        EXPECT_NEAR(out.frame.hand_depth, 0.002, 1e-9);
        EXPECT_GT(out.frame.contacts, 0u);
        EXPECT_EQ(out.frame.status & ~kEngaged, 0u);
    }
}

TEST(ClosedFormProxy, HoldsWhereSidesLieInOnePlaneToRounding) {
    // Truth: closed form: the upper face stays on the lower one, the hand 3 mm below it. Both parts have the same
    // sides, and the hand turns and shifts by so little that rounding says which of them is outside.
    struct Pair {
        shape::Shape held, fixed;
        double z_held, z_fixed;  // faces 0.2 mm apart at z = 0
    };
    const std::vector<Pair> pairs{
        {shape::Box{0.02, 0.02, 0.02}, shape::Box{0.02, 0.02, 0.02}, 0.0102, -0.01},
        {shape::Box{0.02, 0.02, 0.02}, shape::Box{0.02, 0.06, 0.02}, 0.0102, -0.01},
        {shape::Cylinder{0.02, 0.02}, shape::Cylinder{0.02, 0.02}, 0.0102, -0.01},
        {shape::SquarePeg{0.02, 0.02, 0.03, 0.0}, shape::Box{0.02, 0.02, 0.02}, 0.0002, -0.01},
    };
    Random random(5);
    for (const Pair& pair : pairs)
        for (const double jitter : {0.0, 1e-17, 1e-16, 1e-14, 1e-10}) {
            test::Bench bench(closedFormScene(pair.held, at(0, 0, pair.z_held), pair.fixed, at(0, 0, pair.z_fixed)));
            const auto any = [&] { return random.uniform(-jitter, jitter); };
            for (int i = 1; i <= 200; ++i) {
                const double z = pair.z_held - 0.0032 * std::min(1.0, i / 100.0);
                const auto out =
                    bench.step(Pose{rotationFromVector(100.0 * Vec3(any(), any(), any())), Vec3(any(), any(), z)});
                ASSERT_GT(out.X_WG.p.z(), pair.z_held - 0.0002 - kOverlap) << jitter << " m, tick " << i;
            }
        }
}

TEST(ClosedFormProxy, BuildsNeitherFieldNorPoints) {
    // Truth: invariant.
    const test::Bench bench(blockOnTable(ContactMethod::GodObject));
    for (const auto& part : bench.scene().parts) {
        EXPECT_FALSE(part->field);
        EXPECT_FALSE(part->shell);
    }
}

TEST(ClosedFormProxy, GivesEachObstacleItsOwnPush) {
    // Truth: closed form: a ball in the corner of two walls; the wall that the hand lies x behind pushes with K x.
    auto spec = closedFormScene(shape::Sphere{0.01}, at(0.02, 0.02, 0), shape::Box{0.02, 0.08, 0.08}, at(-0.01, 0, 0));
    spec.parts.push_back({.name = "other", .geometry = shape::Box{0.08, 0.02, 0.08}, .X_WP = at(0, -0.01, 0)});
    test::Bench bench(spec);
    for (int i = 0; i <= 200; ++i) {
        const double s = std::min(1.0, i / 150.0);
        bench.step(at(0.02 - 0.018 * s, 0.02 - 0.016 * s, 0.0));
    }
    const auto& pushes = bench.state().pushes;
    EXPECT_NEAR((pushes[0].wrench.force - Vec3(kStiffness * 0.003, 0, 0)).norm(), 0.0, 1e-3);
    EXPECT_NEAR((pushes[1].wrench.force - Vec3(0, kStiffness * 0.001, 0)).norm(), 0.0, 1e-3);
    EXPECT_NEAR(pushes[0].pressure, kStiffness * 0.003, 1e-3);
}

TEST(ClosedFormProxy, LeavesADeepStartWithoutAKick) {
    // Truth: invariant: overlap falls by no more than kRepair a tick, so that the force rises by no more than K times
    // that beside the hand's own motion.
    auto spec = blockOnTable(ContactMethod::GodObject);
    spec.parts[0].X_WP = at(0, 0, 0.003);
    test::Bench bench(spec);
    double before = 0.002;
    for (int i = 0; i < 30; ++i) {
        const TickOutput out = bench.step(at(0, 0, 0.003));
        EXPECT_GE(out.frame.proxy_depth, before - closed_form::kRepair - 1e-9) << i;
        EXPECT_LE(out.frame.proxy_depth, before + 1e-12) << i;
        before = out.frame.proxy_depth;
    }
    EXPECT_LE(before, kOverlap);
    EXPECT_NEAR(bench.state().X_WG.p.z(), 0.005, kOverlap);
}

TEST(ClosedFormProxy, AFilteredProxyOverlapsNoMore) {
    // Truth: closed form: the block slides over the table's edge and down; the proxy lags, and stays out.
    auto spec = blockOnTable(ContactMethod::GodObject);
    spec.contact.proxy_filter = 20.0;
    test::Bench bench(spec);
    double lag = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double t = 1e-3 * i;
        const Pose hand{rotationFromVector(0.2 * Vec3(std::sin(3 * t), std::sin(2 * t), 0)),
                        Vec3(0.04 * std::sin(2 * t), 0, 0.0052 - 0.003 * std::min(1.0, 5 * t))};
        const TickOutput out = bench.step(hand);
        ASSERT_LE(out.frame.proxy_depth, kOverlap) << i;
        lag = std::max(lag, out.X_WG.p.x() - hand.p.x());
    }
    EXPECT_GT(lag, 1e-4);
}

TEST(ClosedFormProxy, FollowsARelocatedHandAndForgetsWhereItWas) {
    // Truth: invariant: where the input guard believes the device to be elsewhere the proxy is there, without a spring.
    auto spec = blockOnTable(ContactMethod::GodObject);
    test::Bench bench(spec);
    for (int i = 0; i < 50; ++i) bench.step(at(0, 0, 0.004));
    TickOutput out;
    for (int i = 0; i < 400; ++i) out = bench.step(at(0.3, 0.1, 0.2));
    EXPECT_NEAR((out.X_WG.p - Vec3(0.3, 0.1, 0.2)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(out.F_D_B.force.norm(), 0.0, 1e-6);
    EXPECT_EQ(out.frame.contacts, 0u);
}

TEST(ClosedFormProxy, AllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    auto spec = blockOnTable(ContactMethod::GodObject);
    spec.contact.proxy_filter = 50.0;
    test::Bench bench(spec);
    const support::RtGuard guard;
    for (int i = 0; i < 3000; ++i) {
        const double t = 1e-3 * i;
        bench.step(Pose{rotationFromVector(0.3 * Vec3(std::sin(3 * t), std::sin(2 * t), std::sin(t))),
                        Vec3(0.04 * std::sin(2 * t), 0.03 * std::sin(3 * t), 0.003)});
    }
    EXPECT_EQ(guard.violations(), 0) << guard.describe();
}

}  // namespace
}  // namespace passung::tick
