#include "core/geometry/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/triangle_tree.h"
#include "tests/support/broken_mesh.h"

namespace passung::geometry {
namespace {

constexpr int kLattice = 24;

Vec3 latticePoint(const TriangleCorners& t, int i, int j) {
    return (i * t[0] + j * t[1] + (kLattice - i - j) * t[2]) / kLattice;
}

TriangleCorners somewhere(Random& random, double reach) {
    const auto point = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    const Vec3 middle = reach * point();
    return {Vec3(middle + point()), Vec3(middle + point()), Vec3(middle + point())};
}

TEST(ClosestPair, IsOfTheTwoTrianglesAndNoPointsOfALatticeAreNearer) {
    // Truth: independent search over two lattices, none of whose points is nearer than the pair, and whose nearest are
    // not farther than two steps of the lattice more. The pair's points lie on their triangles.
    Random random(1);
    int met = 0;
    for (int trial = 0; trial < 120; ++trial) {
        const TriangleCorners a = somewhere(random, 1.0), b = somewhere(random, 1.0);
        const TrianglePair pair = closestPair(a, b, 1e3);
        EXPECT_NEAR((pair.on_first - pair.on_second).norm(), pair.distance, 1e-12);
        EXPECT_LT((closestOnTriangle(pair.on_first, a[0], a[1], a[2]) - pair.on_first).norm(), 1e-12);
        EXPECT_LT((closestOnTriangle(pair.on_second, b[0], b[1], b[2]) - pair.on_second).norm(), 1e-12);
        double nearest = 1e300, longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max({longest, (a[k] - a[(k + 1) % 3]).norm(), (b[k] - b[(k + 1) % 3]).norm()});
        for (int i = 0; i <= kLattice; ++i)
            for (int j = 0; j <= kLattice - i; ++j) {
                const Vec3 p = latticePoint(a, i, j);
                nearest = std::min(nearest, (closestOnTriangle(p, b[0], b[1], b[2]) - p).norm());
            }
        EXPECT_LE(pair.distance, nearest + 1e-12);
        EXPECT_GE(pair.distance, nearest - longest / kLattice);
        met += pair.distance < 1e-12 ? 1 : 0;
    }
    EXPECT_GT(met, 5);
    EXPECT_LT(met, 100);
}

TEST(ClosestPair, NamesNothingNearerThanALimitItDoesNotReach) {
    // Truth: closed form. Two triangles one apart, face to face; and edge over edge, crosswise.
    const TriangleCorners low{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    const TriangleCorners high{Vec3(1, 1, 1), Vec3(2, 1, 1), Vec3(1, 2, 1)};
    EXPECT_NEAR(closestPair(low, high, 2.0).distance, 1.0, 1e-12);
    EXPECT_GE(closestPair(low, high, 0.5).distance, 0.5);
    const TriangleCorners roof{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
    const TriangleCorners across{Vec3(0, -1, 0.25), Vec3(0, 1, 0.25), Vec3(0, 0, 2)};
    EXPECT_NEAR(closestPair(roof, across, 1.0).distance, 0.25, 1e-12);
}

TEST(FindWay, NamesADirectionThatKeepsTheTrianglesApart) {
    // Truth: definition, and the exact distance: none is found where they are nearer, one where they are farther by
    // far.
    Random random(5);
    int found = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const TriangleCorners a = somewhere(random, 0.0), b = somewhere(random, 3.0);
        const double distance = closestPair(a, b, 1e3).distance;
        for (const double share : {0.5, 0.999, 1.001}) {
            Vec3 way = Vec3::Zero();
            if (!findWay(a, b, share * distance, way)) continue;
            ASSERT_LT(share, 1.0);
            ++found;
            ASSERT_NEAR(way.norm(), 1.0, 1e-12);
            for (const Vec3& p : a)
                for (const Vec3& q : b) ASSERT_GT(way.dot(p - q), share * distance - 1e-12);
        }
    }
    EXPECT_GT(found, 1500);
}

TEST(LeastDistance, IsNoMoreThanTheDistanceAnywhereOnTheTriangleAndExactForASinglePoint) {
    // Truth: closed form: the set is one point, whose distance is that from the triangle; with several points, the
    // exact distance of each corner, and a lattice of points on the triangle.
    Random random(6);
    const auto point = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
    for (int trial = 0; trial < 2000; ++trial) {
        TriangleCorners t = somewhere(random, 3.0);
        if (trial % 10 == 0) t[2] = t[0] + 0.3 * (t[1] - t[0]);  // without area
        const std::vector<Vec3> set{point(), point(), point()};
        for (const std::size_t count : {std::size_t{1}, set.size()}) {
            const auto distance = [&](const Vec3& p) {
                double nearest = 1e300;
                for (std::size_t i = 0; i < count; ++i) nearest = std::min(nearest, (set[i] - p).norm());
                return nearest;
            };
            const std::array<double, 3> l{distance(t[0]), distance(t[1]), distance(t[2])};
            double truth = 1e300;
            for (std::size_t i = 0; i < count; ++i)
                truth = std::min(truth, (closestOnTriangle(set[i], t[0], t[1], t[2]) - set[i]).norm());
            const double least = leastDistance(t, l, 1e300);
            ASSERT_LE(least, truth);
            if (count == 1 && trial % 10 != 0 && truth > 1e-3) {
                ASSERT_NEAR(least, truth, 1e-6);
            }
            ASSERT_LE(leastDistance(t, l, 0.0), truth);
        }
    }
}

TEST(TriangleTree, FindsTheNearestPairOfATriangleAndAMesh) {
    // Truth: independent search over all triangles.
    const TriangleMesh mesh = test::wavySphere(0.02, 2e-5);
    const TriangleTree tree(mesh);
    Random random(2);
    for (int trial = 0; trial < 60; ++trial) {
        TriangleCorners t = somewhere(random, 5.0);
        for (Vec3& corner : t) corner *= 0.004;
        double nearest = 1e300;
        for (const auto& v : mesh.triangles)
            nearest = std::min(
                nearest, closestPair(t, {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]}, 1e3).distance);
        EXPECT_NEAR(tree.closestTo(t, 1.0).distance, nearest, 1e-12);
        EXPECT_EQ(tree.closestTo(t, 0.5 * nearest).distance, 0.5 * nearest);
    }
}

TEST(TriangleTree, FindsWhatReachesAboveAPlaneInABox) {
    // Truth: independent search over all triangles.
    const TriangleMesh mesh = test::wavySphere(0.02, 2e-5);
    const TriangleTree tree(mesh);
    Random random(8);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        const double least = random.uniform(-0.02, 0.02);
        Bounds box;
        for (int i = 0; i < 2; ++i) box.extend(0.02 * Vec3(random.normal(), random.normal(), random.normal()));
        std::vector<std::uint32_t> found;
        tree.findAbove(box, way, least, found);
        std::size_t expected = 0;
        const auto isIn = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
            const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
            return (low.array() <= box.high.array()).all() && (high.array() >= box.low.array()).all() &&
                   std::max({way.dot(a), way.dot(b), way.dot(c)}) >= least;
        };
        for (const auto& v : mesh.triangles)
            expected += isIn(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]) ? 1u : 0u;
        EXPECT_EQ(found.size(), expected);
        for (const std::uint32_t place : found) {
            const auto& t = tree.corners()[place];
            EXPECT_TRUE(isIn(t.a, t.b, t.c));
        }
    }
}

}  // namespace
}  // namespace passung::geometry
