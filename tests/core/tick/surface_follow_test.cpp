#include "core/tick/surface_follow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mesh_crossing.h"
#include "tests/support/rt_guard.h"
#include "tests/support/scenes.h"

namespace passung::tick {
namespace {

using scene::ContactMethod;

constexpr double kStiffness = 2000.0;  // [N/m]

Pose at(double x, double y, double z) { return {Quat::Identity(), Vec3(x, y, z)}; }

scene::SceneSpec surfaceScene(const shape::Shape& held, const Pose& X_WHeld, const shape::Shape& fixed,
                              const Pose& X_WFixed, ContactMethod method = ContactMethod::GodObject) {
    auto spec = test::scene(held, X_WHeld, fixed, X_WFixed, method);
    spec.contact.geometry = scene::Geometry::Surface;
    spec.contact.stiffness = kStiffness;
    return spec;
}

/// A block of 10 mm over a table whose top is z = 0.
scene::SceneSpec blockOnTable(ContactMethod method) {
    return surfaceScene(shape::Box{0.02, 0.02, 0.01}, at(0, 0, 0.0052), shape::Box{0.06, 0.06, 0.02}, at(0, 0, -0.01),
                        method);
}

TEST(SurfaceFollow, RestsOnAPlaneOneGapAwayAndPushesWithTheSpring) {
    // Truth: closed form: the hand 2 mm below the plane, K times that and the gap, nothing along it.
    for (const ContactMethod method : {ContactMethod::GodObject, ContactMethod::GodObjectHeuristic}) {
        test::Bench bench(blockOnTable(method));
        TickOutput out;
        for (int i = 0; i <= 200; ++i) out = bench.step(at(0.001, 0.0, 0.0052 - 2.2e-5 * std::min(i, 100)));
        EXPECT_NEAR(out.X_WG.p.z(), 0.005 + kSurfaceGap, 0.2 * kSurfaceGap);
        EXPECT_NEAR(out.X_WG.p.x(), 0.001, 1e-8);
        EXPECT_NEAR((out.F_D_B.force - Vec3(0, 0, kStiffness * 0.002)).norm(), 0.0, 1.5 * kStiffness * kSurfaceGap);
        EXPECT_EQ(out.frame.proxy_depth, 0.0);
        EXPECT_NEAR(out.frame.proxy_gap, out.X_WG.p.z() - 0.005, 0.1 * kSurfaceGap);
        EXPECT_LE(out.frame.proxy_gap, out.X_WG.p.z() - 0.005);
        EXPECT_NEAR(out.frame.hand_depth, 0.002, 2.0 * kSurfaceGap);
        EXPECT_GT(out.frame.contacts, 0u);
        EXPECT_EQ(out.frame.status & ~kEngaged, 0u);
    }
}

TEST(SurfaceFollow, BuildsNeitherFieldNorPoints) {
    // Truth: invariant.
    const test::Bench bench(blockOnTable(ContactMethod::GodObject));
    for (const auto& part : bench.scene().parts) {
        EXPECT_FALSE(part->field);
        EXPECT_FALSE(part->shell);
    }
}

TEST(SurfaceFollow, AFreeProxyIsTheHand) {
    // Truth: invariant.
    test::Bench bench(blockOnTable(ContactMethod::GodObject));
    for (int i = 0; i < 500; ++i) {
        const double t = 1e-3 * i;
        const Pose hand{rotationFromVector(0.5 * Vec3(std::sin(3 * t), std::sin(2 * t), std::sin(t))),
                        Vec3(0.04 * std::sin(2 * t), 0.02 * std::sin(3 * t), 0.0052 + 0.05 * std::min(1.0, 2 * t))};
        const TickOutput out = bench.step(hand);
        if (i < 300) continue;
        ASSERT_NEAR((out.X_WG.p - hand.p).norm(), 0.0, 1e-8) << i;
        ASSERT_NEAR(out.X_WG.q.angularDistance(hand.q), 0.0, 1e-6) << i;
    }
}

TEST(SurfaceFollow, GivesEachObstacleItsOwnPush) {
    // Truth: closed form: a block in the corner of two walls; the wall that the hand lies x behind pushes with K x.
    auto spec =
        surfaceScene(shape::Box{0.01, 0.01, 0.01}, at(0.02, 0.02, 0), shape::Box{0.02, 0.08, 0.08}, at(-0.01, 0, 0));
    spec.parts.push_back({.name = "other", .geometry = shape::Box{0.08, 0.02, 0.08}, .X_WP = at(0, -0.01, 0)});
    test::Bench bench(spec);
    for (int i = 0; i <= 300; ++i) {
        const double s = std::min(1.0, i / 200.0);
        bench.step(at(0.02 - 0.018 * s, 0.02 - 0.016 * s, 0.0));
    }
    const auto& pushes = bench.state().pushes;
    EXPECT_NEAR((pushes[0].wrench.force - Vec3(kStiffness * 0.003, 0, 0)).norm(), 0.0, 0.01);
    EXPECT_NEAR((pushes[1].wrench.force - Vec3(0, kStiffness * 0.001, 0)).norm(), 0.0, 0.01);
    EXPECT_NEAR(pushes[0].pressure, kStiffness * 0.003, 0.01);
}

TEST(SurfaceFollow, LeavesAStartInOverlapNoFasterThanAMetreASecond) {
    // Truth: independent oracle (mesh_crossing.h): the triangles cross at first, then never again.
    auto spec = blockOnTable(ContactMethod::GodObject);
    spec.parts[0].X_WP = at(0, 0, 0.003);
    test::Bench bench(spec);
    test::MeshPairTruth truth(bench.scene().parts[0]->mesh, bench.scene().parts[1]->mesh);
    Pose last = at(0, 0, 0.003);
    bool free = false;
    for (int i = 0; i < 40; ++i) {
        const TickOutput out = bench.step(at(0, 0, 0.003));
        EXPECT_LE((out.X_WG.p - last.p).norm(), 1.001e-3) << i;
        last = out.X_WG;
        const double distance = truth.distance({last.q, last.p + Vec3(0, 0, 0.01)}, 1e-6);
        EXPECT_TRUE(!free || distance > 0.0) << i;
        free = distance > 0.0;
    }
    EXPECT_TRUE(free);
}

TEST(SurfaceFollow, AllocatesNothing) {
    // Truth: invariant.
    if (!support::RtGuard::available()) GTEST_SKIP() << "a sanitizer owns the allocator";
    test::Bench bench(blockOnTable(ContactMethod::GodObject));
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
