#include "core/model/triangle_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/model/triangle_tree.h"
#include "tests/support/broken_mesh.h"

namespace passung::model {
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

}  // namespace
}  // namespace passung::model
