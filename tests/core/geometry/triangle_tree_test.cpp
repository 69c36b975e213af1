#include "core/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"
#include "core/shape/shape.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/brute_force_mesh.h"

namespace passung::geometry {
namespace {

std::vector<Vec3> pointsAround(const TriangleMesh& mesh, int count, Random& random) {
    const Bounds bounds = boundsOf(mesh);
    const double margin = 0.2 * bounds.size().norm();
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = random.uniform(bounds.low[k] - margin, bounds.high[k] + margin);
        if (i % 2 == 1) {
            const auto& t = mesh.triangles[random.below(mesh.triangles.size())];
            p = mesh.vertices[t[0]] + 1e-4 * Vec3(random.normal(), random.normal(), random.normal());
        }
        points.push_back(p);
    }
    return points;
}

/// Triangles of all sizes at random.
TriangleMesh soup(Random& random) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 900; ++i) {
        const Vec3 centre(random.uniform(), random.uniform(), random.uniform());
        const double size = std::pow(10.0, random.uniform(-3.0, -0.5));
        for (int k = 0; k < 3; ++k)
            mesh.vertices.push_back(centre + size * Vec3(random.normal(), random.normal(), random.normal()));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// The same made needles of any height down to rounding, lines and points.
TriangleMesh needles(Random& random) {
    TriangleMesh mesh = soup(random);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t v = mesh.triangles[i][0];
        Vec3 &a = mesh.vertices[v], &b = mesh.vertices[v + 1], &c = mesh.vertices[v + 2];
        const Vec3 aside(random.normal(), random.normal(), random.normal());
        c = a + random.uniform(-0.2, 1.2) * (b - a) + std::pow(10.0, random.uniform(-18.0, -2.0)) * aside;
        if (i % 8 == 0) c = a + 0.5 * (b - a);
        if (i % 8 == 1) b = a;
        if (i % 8 == 2) c = a;
        if (i % 8 == 3) c = b;
        if (i % 8 == 4) c = b = a;
    }
    return mesh;
}

TEST(TriangleTree, FindsTheClosestPointThatASearchOverAllTrianglesFinds) {
    // Truth: closed form, a plain search over all triangles with another formula.
    Random random(11);
    const std::vector<TriangleMesh> meshes{
        test::wavySphere(0.02, 2e-5), shape::tessellate(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.001}, 1e-5),
        shape::tessellate(shape::Sheet{0.04, 0.03}, 1.0), soup(random), needles(random)};
    for (const TriangleMesh& mesh : meshes) {
        const TriangleTree tree(mesh);
        const double size = boundsOf(mesh).size().norm();
        for (const Vec3& p : pointsAround(mesh, 500, random)) {
            const ClosestPoint found = tree.closest(p);
            ASSERT_NEAR(found.distance, test::distanceToMesh(mesh, p), 1e-9 * size);
            ASSERT_NEAR((found.point - p).norm(), found.distance, 1e-12 * size);
            // The point lies on the triangle that is named.
            ASSERT_LE(test::distanceToTriangle(mesh, found.triangle, found.point), 1e-9 * size);
        }
    }
}

TEST(TriangleTree, HoldsTheNearestTriangleOfEveryPointOfACube) {
    // Truth: invariant, TriangleTree::closest at random points of the cube and at its corners.
    Random random(8);
    for (const TriangleMesh& mesh :
         {shape::tessellate(shape::Torus{0.04, 0.012}, 1e-5), soup(random), needles(random)}) {
        const TriangleTree tree(mesh);
        const Bounds bounds = boundsOf(mesh);
        std::size_t fewest = mesh.triangles.size();
        for (int i = 0; i < 200; ++i) {
            const double half = 0.1 * random.uniform() * bounds.size().maxCoeff();
            const auto in = [&](double reach) {
                return Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach),
                            random.uniform(-reach, reach));
            };
            const Vec3 centre = 0.5 * (bounds.low + bounds.high) + in(0.8 * bounds.size().maxCoeff());
            std::vector<std::uint32_t> found;
            tree.findNearest(centre, half, found);
            fewest = std::min(fewest, found.size());
            for (int k = 0; k < 20; ++k) {
                const Vec3 p =
                    centre + (k < 8 ? Vec3(half * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)) : in(half));
                const ClosestPoint nearest = tree.closest(p);
                if (std::find(found.begin(), found.end(), nearest.place) != found.end()) continue;
                double least = std::numeric_limits<double>::infinity();  // of others as near
                for (const std::uint32_t t : found) {
                    const auto& [a, b, c, needle] = tree.corners()[t];
                    least = std::min(least, TriangleTree(TriangleMesh{{a, b, c}, {{0, 1, 2}}}).closest(p).distance);
                }
                ASSERT_NEAR(least, nearest.distance, 1e-12);
            }
        }
        EXPECT_LT(fewest, mesh.triangles.size() / 4);  // most are left out of a small cube
    }
}

TEST(TriangleTree, StopsAtTheLimit) {
    // Truth: closed form. A box: 5 mm outside is found with a limit of 5.1 mm, and not with one of 4.9 mm.
    const TriangleTree tree(shape::tessellate(shape::Box{0.02, 0.02, 0.02}, 1.0));
    const Vec3 p(0.015, 0.001, 0.002);
    EXPECT_NEAR(tree.closest(p, 0.0051).distance, 0.005, 1e-15);
    EXPECT_EQ(tree.closest(p, 0.0049).distance, 0.0049);
}

TEST(TriangleTree, ServesOneTriangleAndManyEqualOnes) {
    // Truth: closed form. Equal triangles cannot be separated by any plane; the tree must still end.
    TriangleMesh mesh;
    mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    mesh.triangles = {{0, 1, 2}};
    EXPECT_NEAR(TriangleTree(mesh).closest(Vec3(0.2, 0.2, -0.7)).distance, 0.7, 1e-15);
    mesh.triangles.assign(5000, Triangle{0, 1, 2});
    EXPECT_NEAR(TriangleTree(mesh).closest(Vec3(-3.0, -4.0, 0.0)).distance, 5.0, 1e-15);
}

TEST(TriangleTree, WindingNumberIsTheSumOfSolidAngles) {
    // Truth: closed form, the solid angles of all triangles by Girard's theorem. Dipoles that stand in for clusters two
    // radii away err by a few thousandths each (less with the square of that distance), 0.042 at most in sum here;
    // 0.06 leaves a wide margin to the threshold of 0.5.
    Random random(12);
    const std::vector<TriangleMesh> meshes{
        test::wavySphere(0.02, 2e-5), shape::tessellate(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.001}, 1e-5),
        shape::tessellate(shape::Sheet{0.04, 0.03}, 1.0)};
    for (const TriangleMesh& mesh : meshes) {
        const TriangleTree tree(mesh);
        double worst = 0.0;
        for (const Vec3& p : pointsAround(mesh, 500, random))
            worst = std::max(worst, std::abs(tree.windingNumber(p) - test::windingNumber(mesh, p)));
        EXPECT_LE(worst, 0.06);
    }
}

TEST(TriangleTree, SolidAnglesAreExactWithinALeaf) {
    // Truth: closed form. Four triangles are one leaf, evaluated without dipoles nearby: a tetrahedron winds 1 and 0.
    TriangleMesh mesh;
    mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const TriangleTree tree(mesh);
    Random random(13);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p(random.uniform(-0.3, 0.7), random.uniform(-0.3, 0.7), random.uniform(-0.3, 0.7));
        const bool inside = p.minCoeff() > 0.0 && p.sum() < 1.0;
        ASSERT_NEAR(tree.windingNumber(p), inside ? 1.0 : 0.0, 1e-12) << p.transpose();
    }
}

TEST(TriangleTree, KnowsInsideFromOutsideUpToTheTriangles) {
    // Truth: closed form. Points farther from the surface than the chord error, on both sides of it.
    const double chord_error = 1e-6;
    Random random(14);
    for (const shape::Shape& shape :
         {shape::Shape(shape::Sphere{0.02}), shape::Shape(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.02, 0.001}),
          shape::Shape(shape::BorePlate{0.06, 0.05, 0.03, 0.0202, 0.03, 0.0}),
          shape::Shape(shape::Peg{0.02, 0.05, 0.001})}) {
        const TriangleMesh mesh = shape::tessellate(shape, chord_error);
        const TriangleTree tree(mesh);
        for (const Vec3& p : pointsAround(mesh, 4000, random)) {
            const double distance = shape::signedDistance(shape, p);
            if (std::abs(distance) < 2 * chord_error) continue;
            ASSERT_EQ(tree.inside(p), distance < 0.0) << shape::kindName(shape) << " at " << p.transpose();
        }
    }
}

TEST(TriangleTree, KnowsInsideFromOutsideDespiteDefects) {
    // Truth: closed form. A patch within 2 mm around the pole of a sphere of radius 10 mm is missing, turned or
    // doubled. From 4 mm away it fills less than a tenth of the view (π·2²/4² of 4π is 0.06): a hole moves the winding
    // number by that, a turned patch by twice that, a doubled one by that again: never past one half.
    const shape::Shape sphere = shape::Sphere{0.02};
    const TriangleMesh sound = shape::tessellate(sphere, 2e-6);
    const Vec3 pole(0.0, 0.0, 0.01);
    const auto patch = test::patchAround(sound, pole, 2e-3);
    ASSERT_GT(patch.size(), 50u);
    Random random(15);
    for (const TriangleMesh& mesh :
         {test::withHole(sound, patch), test::withFlipped(sound, patch), test::withDuplicates(sound, patch)}) {
        const TriangleTree tree(mesh);
        for (const Vec3& p : pointsAround(sound, 4000, random)) {
            const double distance = shape::signedDistance(sphere, p);
            if (std::abs(distance) < 4e-6 || (p - pole).norm() < 4e-3) continue;
            ASSERT_EQ(tree.inside(p), distance < 0.0) << p.transpose();
        }
    }
}

}  // namespace
}  // namespace passung::geometry
