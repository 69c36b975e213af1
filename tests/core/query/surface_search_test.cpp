#include "core/query/surface_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace passung {
namespace {

scene::Part build(const shape::Shape& shape, double tolerance, bool field) {
    const scene::PartSpec spec{.name = {}, .geometry = shape, .X_WP = {}};
    auto part = scene::buildPart(spec, {.field = field, .shell = false, .tolerance = tolerance});
    EXPECT_TRUE(part);
    return std::move(*part);
}

/// The distance of two meshes that do not meet, from every triangle of `b`.
double distanceOf(const geometry::TriangleTree& a, const geometry::TriangleMesh& b, const Pose& X_AB) {
    double nearest = 1e3;
    for (const auto& v : b.triangles) {
        const auto corner = [&](std::size_t i) { return Vec3(X_AB * b.vertices[v[i]]); };
        nearest = std::min(nearest, a.closestTo({corner(0), corner(1), corner(2)}, nearest).distance);
    }
    return nearest;
}

TEST(SurfaceSearch, ProvesTheDistanceThatAllTrianglesTogetherHaveToAnyTolerance) {
    // Truth: exhaustive search over all triangles of B. A ring over a peg with key: rims, edges and curved faces next
    // to each other, from touching to far away.
    const scene::Part key = build(shape::KeyedPeg{0.02, 0.05, 0.004, 0.003, 0.001}, 100e-6, true);
    const scene::Part ring = build(shape::Torus{0.03, 0.008}, 200e-6, false);
    const geometry::TriangleTree exact(key.mesh);
    query::SurfaceSearch search(key, ring);
    Random random(7);
    int near = 0;
    for (int i = 0; i < 60; ++i) {
        const Vec3 axis(random.normal(), random.normal(), random.normal());
        const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        Pose X_AB{rotationFromVector(axis), (0.02 + 0.02 * random.uniform()) * way + Vec3(0, 0, 0.025)};
        const double truth = distanceOf(exact, ring.mesh, X_AB);
        if (!(truth > 1e-6)) continue;
        near += truth < 3e-3 ? 1 : 0;
        const Vec3& somewhere = ring.mesh.vertices[random.below(ring.mesh.vertices.size())];
        for (const double tolerance : {20e-6, 1e-6, 0.0}) {
            const auto found = search.bounds(X_AB, somewhere, 0.0, tolerance, 1'000'000);
            ASSERT_LE(found.lower, truth + 1e-12) << i;
            ASSERT_GE(found.upper, truth - 1e-12) << i;
            ASSERT_LE(found.upper - found.lower, tolerance + 1e-11) << i;
            ASSERT_NEAR(exact.closest(found.point).distance, found.upper, 1e-12) << i;
        }
        const auto early = search.bounds(X_AB, somewhere, 0.0, 0.0, 200);
        ASSERT_LE(early.lower, truth + 1e-12) << i;
        ASSERT_GE(early.upper, truth - 1e-12) << i;
        ASSERT_LE(early.steps, 200) << i;
    }
    EXPECT_GT(near, 6);
}

}  // namespace
}  // namespace passung
