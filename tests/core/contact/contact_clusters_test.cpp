#include "core/contact/contact_clusters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/shape/shape.h"
#include "core/shell/point_shell.h"
#include "tests/support/rt_guard.h"

namespace passung {
namespace {

using contact::ContactCluster;

/// Points of `shell` at `X_WS` that are below the plane z = 0.
void pressOnPlane(const shell::PointShell& shell, const Pose& X_WS, contact::ContactManifold& manifold) {
    for (const shell::SurfacePoint& point : shell.points) {
        const Vec3 p = X_WS * point.position;
        if (!(p.z() < 0.0)) continue;
        manifold.tryPush({.position = p,
                          .normal = X_WS.q * point.normal,
                          .gradient = Vec3::UnitZ(),
                          .phi = p.z(),
                          .area = point.area});
    }
}

TEST(ContactClusters, FindsAHundredDisjointPatchesEachWithItsAreaDepthAndPlace) {
    // Truth: closed form. A hundred balls of radius R, 12 mm apart, turned at random, each h deep in a plane: caps with
    // area 2πRh, volume below π h² (3R - h)/3, whose border has the length 2π √(2Rh - h²). A patch may miss or have too
    // much within a cover radius of the border; in the mean over a hundred what is missed and what is too much cancel
    // but for 1 % (areas are off by 5 % of their own, and √100).
    constexpr double R = 4e-3;
    const shell::PointShell ball = shell::samplePoints(shape::tessellate(shape::Sphere{2 * R}, 2e-6), 0.3e-3);
    contact::ContactManifold manifold(100'000);
    Random random(3);
    std::vector<double> depth;
    for (int i = 0; i < 100; ++i) {
        depth.push_back(random.uniform(0.3e-3, 0.5e-3));
        const Vec3 turn(random.normal(), random.normal(), random.normal());
        pressOnPlane(ball, {rotationFromVector(turn), Vec3(12e-3 * (i % 10), 12e-3 * (i / 10), R - depth.back())},
                     manifold);
    }
    contact::ClusterFinder finder(manifold.size());
    support::RtGuard guard;
    const auto clusters = finder.find(manifold, 2.0 * ball.cover_radius);
    if (support::RtGuard::available()) {
        EXPECT_EQ(guard.violations(), 0) << guard.describe();
    }
    ASSERT_EQ(clusters.size(), 100u);
    EXPECT_EQ(finder.found(), 100u);
    std::set<int> seen;
    double total = 0.0, truth = 0.0, last = -1.0;
    for (const ContactCluster& cluster : clusters) {
        const auto column = std::lround(cluster.deepest.x() / 12e-3), row = std::lround(cluster.deepest.y() / 12e-3);
        const auto i = static_cast<std::size_t>(10 * row + column);
        seen.insert(static_cast<int>(i));
        const Vec3 under(12e-3 * static_cast<double>(column), 12e-3 * static_cast<double>(row), 0.0);
        const double h = depth.at(i), area = 2.0 * std::numbers::pi * R * h, c = ball.cover_radius;
        const double border = 2.0 * std::numbers::pi * std::sqrt(2 * R * h - h * h);
        const double volume = std::numbers::pi * h * h * (3 * R - h) / 3.0;
        EXPECT_NEAR(cluster.area, area, border * c);
        EXPECT_NEAR(cluster.push.z(), volume, 0.05 * volume);
        EXPECT_LE(-cluster.phi, h);
        EXPECT_GE(-cluster.phi, h - c * c / (2 * R) - 4e-6);  // the tessellation and its floats
        EXPECT_LT((cluster.deepest - under).head<2>().norm(), 1.1 * c);
        EXPECT_LT((cluster.pressure_point - under).head<2>().norm(), 0.05e-3);
        EXPECT_GT(cluster.normal.z(), 0.999);
        EXPECT_GE(cluster.phi, last);
        last = cluster.phi;
        total += cluster.area;
        truth += area;
    }
    EXPECT_EQ(seen.size(), 100u);
    EXPECT_NEAR(total, truth, 0.01 * truth);
}

TEST(ContactClusters, TakesARingOfContactAsOne) {
    // Truth: closed form. A torus, ring radius 20 mm, tube 6 mm, lies 0.4 mm deep in a plane: a ring of width
    // 2 √(2rh - h²); ∫ over the tube's angle of r dψ times the mean circumference gives the area. Its middle is the
    // torus's; off by the border, two circles of about 125 mm each, and by 1 % in the mean.
    constexpr double r = 6e-3, ring = 20e-3, h = 0.4e-3;
    const shell::PointShell torus = shell::samplePoints(shape::tessellate(shape::Torus{2 * ring, 2 * r}, 2e-6), 0.6e-3);
    contact::ContactManifold manifold(torus.points.size());
    pressOnPlane(torus, {Quat::Identity(), Vec3(0, 0, r - h)}, manifold);
    contact::ClusterFinder finder(manifold.size());
    const auto clusters = finder.find(manifold, 2.0 * torus.cover_radius);
    ASSERT_EQ(clusters.size(), 1u);
    const double area = 2.0 * std::numbers::pi * ring * 2.0 * r * std::acos((r - h) / r);
    EXPECT_NEAR(clusters[0].area, area, 0.02 * area);
    EXPECT_LT(clusters[0].pressure_point.head<2>().norm(), 0.1e-3);
    EXPECT_EQ(clusters[0].points, manifold.size());
}

TEST(ContactClusters, PartsTheTwoWallsOfASlotHoweverThinTheWallBetweenThem) {
    // Truth: closed form. A wall 0.2 mm thick is squeezed on both faces, its edges with it: two patches of 10 mm x 10
    // mm with opposite normals, though the points of one face are nearer to the other face than to each other. An edge
    // pushes as the obstacle's face next to it does; all edges belong to one of the two.
    const shell::PointShell wall =
        shell::samplePoints(shape::tessellate(shape::Box{0.2e-3, 10e-3, 10e-3}, 1e-6), 0.5e-3);
    contact::ContactManifold manifold(wall.points.size());
    std::size_t edges = 0;
    for (const shell::SurfacePoint& point : wall.points) {
        const double side = point.position.x() > 0.0 ? 1.0 : -1.0;
        const bool edge = !(point.area > 0.0);
        if (!edge && std::abs(point.normal.x()) < 0.9) continue;
        edges += edge ? 1u : 0u;
        manifold.tryPush({.position = point.position,
                          .normal = side * Vec3::UnitX(),
                          .gradient = -side * Vec3::UnitX(),
                          .phi = side > 0.0 ? -10e-6 : -20e-6,
                          .area = point.area});
    }
    ASSERT_GT(edges, 20u);
    contact::ClusterFinder finder(manifold.size());
    const auto clusters = finder.find(manifold, 2.0 * wall.cover_radius);
    ASSERT_EQ(clusters.size(), 2u);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        const double side = i == 0 ? -1.0 : 1.0;  // the deeper one first
        EXPECT_NEAR(clusters[i].normal.x(), -side, 1e-9);
        EXPECT_NEAR(clusters[i].area, 1e-4, 1e-9);
        EXPECT_NEAR(clusters[i].pressure_point.x(), side * 0.1e-3, 1e-8);
    }
    EXPECT_EQ(clusters[0].points + clusters[1].points, manifold.size());
}

TEST(ContactClusters, ListsTheDeepestAndCountsTheOthers) {
    // Truth: invariant. Three hundred points far from each other, half of them without area; what is not inside and
    // spheres are no contact.
    contact::ContactManifold manifold(1000);
    for (int i = 0; i < 300; ++i)
        manifold.tryPush({.position = Vec3(0.01 * i, 0, 0),
                          .normal = -Vec3::UnitZ(),
                          .gradient = Vec3::UnitZ(),
                          .phi = -1e-6 * ((i * 7) % 300 + 1),
                          .area = i % 2 == 0 ? 1e-6 : 0.0});
    manifold.tryPush(
        {.position = Vec3(-1, 0, 0), .normal = Vec3::UnitZ(), .gradient = Vec3::UnitZ(), .phi = 1e-9, .area = 1e-6});
    manifold.tryPush({.position = Vec3(-2, 0, 0),
                      .normal = Vec3::UnitZ(),
                      .gradient = Vec3::UnitZ(),
                      .phi = -1e-3,
                      .area = 1e-6,
                      .radius = 1e-3});
    contact::ClusterFinder finder(manifold.size());
    const auto clusters = finder.find(manifold, 1e-3);
    EXPECT_EQ(finder.found(), 300u);
    ASSERT_EQ(clusters.size(), contact::ClusterFinder::kMostClusters);
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        EXPECT_NEAR(clusters[i].phi, -1e-6 * static_cast<double>(300 - i), 1e-15);
        EXPECT_EQ(clusters[i].points, 1u);
        EXPECT_NEAR(clusters[i].normal.z(), 1.0, 1e-12);
    }
    manifold.clear();
    EXPECT_EQ(finder.find(manifold, 1e-3).size(), 0u);
}

}  // namespace
}  // namespace passung
