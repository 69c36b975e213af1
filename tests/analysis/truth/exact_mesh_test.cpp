#include "analysis/truth/exact_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/shape/shape.h"

namespace passung::truth {
namespace {

constexpr double kChord = 20e-6;  // of the tessellated round shapes [m]

ExactMesh meshOf(const shape::Shape& shape) { return ExactMesh(shape::tessellate(shape, kChord)); }

Vec3 randomPoint(Random& random, const Vec3& half) {
    return {random.uniform(-half.x(), half.x()), random.uniform(-half.y(), half.y()),
            random.uniform(-half.z(), half.z())};
}

Pose randomPose(Random& random, double reach) {
    const Quat q(random.normal(), random.normal(), random.normal(), random.normal());
    return {q.normalized(), randomPoint(random, Vec3::Constant(reach))};
}

double boxDistance(const Vec3& p, const Vec3& half) {
    const Vec3 q = p.cwiseAbs() - half;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// Sum of the solid angles of all triangles over 4π: 1 inside, 0 outside.
double windingNumber(const ExactMesh& mesh, const Vec3& p) {
    double sum = 0.0;
    for (const Corners& t : mesh.triangles()) {
        const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}

TEST(DistanceToTriangle, IsExactOverFaceEdgesAndCorners) {
    // Truth: closed form (right triangle with legs 3 and 4 in z = 0)
    const Corners t{Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 4, 0)};
    EXPECT_DOUBLE_EQ(distanceToTriangle({1, 1, 2}, t), 2.0);                    // face
    EXPECT_DOUBLE_EQ(distanceToTriangle({1, 1, -2}, t), 2.0);                   // face, from behind
    EXPECT_DOUBLE_EQ(distanceToTriangle({1, -3, 4}, t), 5.0);                   // edge y = 0
    EXPECT_DOUBLE_EQ(distanceToTriangle({-3, -4, 0}, t), 5.0);                  // corner
    EXPECT_NEAR(distanceToTriangle({1.5 + 0.8, 2.0 + 0.6, 0}, t), 1.0, 1e-15);  // long edge, along its normal (4, 3)/5
}

TEST(DistanceToTriangle, TreatsASliverAsItsEdges) {
    // Truth: closed form (three corners on one line are a segment)
    const Corners t{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
    EXPECT_DOUBLE_EQ(distanceToTriangle({1.3, 0.5, 0}, t), 0.5);
    EXPECT_DOUBLE_EQ(distanceToTriangle({3, 0, 0}, t), 1.0);
}

TEST(ExactMesh, HasTheSignedDistanceOfABox) {
    // Truth: closed form (a box is its mesh)
    const Vec3 half(0.03, 0.02, 0.01);
    const ExactMesh mesh = meshOf(shape::Box{0.06, 0.04, 0.02});
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = randomPoint(random, 2.0 * half);
        ASSERT_NEAR(mesh.signedDistance(p), boxDistance(p, half), 1e-15) << p.transpose();
    }
}

TEST(ExactMesh, HasTheSignedDistanceOfASphereUpToItsChords) {
    // Truth: closed form (|p| - r; the mesh lies at most one chord error inside)
    const ExactMesh mesh = meshOf(shape::Sphere{0.04});
    Random random(2);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = randomPoint(random, Vec3::Constant(0.04));
        const double difference = mesh.signedDistance(p) - (p.norm() - 0.02);
        ASSERT_GE(difference, -1e-15);
        ASSERT_LE(difference, kChord);
    }
}

TEST(ExactMesh, FindsTheNearestOfAllTriangles) {
    // Truth: invariant (the smallest distance over every triangle, no grid)
    const ExactMesh mesh = meshOf(shape::BorePlate{0.06, 0.05, 0.02, 0.0202, 0.015, 0.001});
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p = randomPoint(random, Vec3(0.08, 0.08, 0.05));
        double least = 1e300;
        for (const Corners& t : mesh.triangles()) least = std::min(least, distanceToTriangle(p, t));
        const ExactMesh::Nearest nearest = mesh.nearest(p);
        ASSERT_EQ(nearest.distance, least);
        ASSERT_EQ(distanceToTriangle(p, mesh.triangles()[nearest.triangle]), least);
    }
}

TEST(ExactMesh, CollectsEveryTriangleAround) {
    // Truth: invariant (every triangle within the radius, found by looking at all, is in the list)
    const ExactMesh mesh = meshOf(shape::Peg{0.02, 0.04, 0.001});
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const Vec3 p = randomPoint(random, Vec3(0.02, 0.02, 0.05));
        const double radius = random.uniform(1e-4, 1e-2);
        std::vector<std::uint32_t> list;
        mesh.collectAround(p, radius, list);
        for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
            if (distanceToTriangle(p, mesh.triangles()[t]) > radius) continue;
            ASSERT_NE(std::find(list.begin(), list.end(), t), list.end()) << t;
        }
    }
}

TEST(ExactMesh, ContainsWhatTheWindingNumberContains) {
    // Truth: invariant (winding number, another way to tell inside from outside, summed over all triangles)
    Random random(5);
    for (const shape::Shape& shape : {shape::Shape{shape::Sphere{0.04}}, shape::Shape{shape::Peg{0.02, 0.04, 0.002}},
                                      shape::Shape{shape::BorePlate{0.04, 0.04, 0.03, 0.02, 0.02, 0.001}},
                                      shape::Shape{shape::BorePlate{0.04, 0.04, 0.03, 0.02, 0.03, 0.0}}}) {
        const ExactMesh mesh = meshOf(shape);
        int inside = 0;
        for (int i = 0; i < 1000; ++i) {
            const Vec3 p = randomPoint(random, Vec3(0.022, 0.022, 0.042));
            const double winding = windingNumber(mesh, p);
            if (std::abs(winding - 0.5) < 0.4) continue;  // within rounding of the surface
            ASSERT_EQ(mesh.contains(p), winding > 0.5) << shape::kindName(shape) << ' ' << p.transpose();
            inside += winding > 0.5 ? 1 : 0;
        }
        EXPECT_GT(inside, 50) << shape::kindName(shape);
    }
}

TEST(ExactMesh, ContainsIsRightForPointsStraightBelowVertices) {
    // Truth: closed form (the grid of a box's corners and edge directions, where rays along axes would graze)
    const ExactMesh mesh = meshOf(shape::Box{2.0, 2.0, 2.0});
    for (const double x : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
        for (const double y : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
            for (const double z : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
                const bool inside = std::max({std::abs(x), std::abs(y), std::abs(z)}) < 1.0;
                EXPECT_EQ(mesh.contains({x, y, z}), inside) << x << ' ' << y << ' ' << z;
            }
        }
    }
}

TEST(DeepestPoint, IsTheDepthOfABallInABlock) {
    // Truth: closed form (ball 2 mm deep; the ball's mesh lies at most one chord error inside the ball)
    const ExactMesh block = meshOf(shape::Box{0.1, 0.1, 0.1});
    const ExactMesh ball = meshOf(shape::Sphere{0.02});
    Random random(6);
    for (int i = 0; i < 20; ++i) {
        const Pose X_FS{randomPose(random, 0.0).q, Vec3(random.uniform(-0.03, 0.03), 0.01, 0.05 + 0.01 - 0.002)};
        const DeepestPoint deepest = deepestPoint(block, ball, X_FS, 1e-6);
        EXPECT_LE(deepest.depth, 0.002 + 1e-15);
        EXPECT_GE(deepest.depth + deepest.uncertainty, 0.002 - kChord);
        EXPECT_LE(deepest.uncertainty, 1e-6);
        EXPECT_NEAR(block.signedDistance(deepest.point), -deepest.depth, 1e-15);
    }
}

TEST(DeepestPoint, FindsACornerThatPiercesAFace) {
    // Truth: closed form (a cube stands on its corner, which is 1 mm deep; every triangle's centre is outside)
    const ExactMesh block = meshOf(shape::Box{0.1, 0.1, 0.1});
    const ExactMesh cube = meshOf(shape::Box{0.02, 0.02, 0.02});
    const Quat on_corner = rotationBetween(Vec3(1, 1, 1), Vec3(0, 0, -1));
    const double half_diagonal = 0.01 * std::sqrt(3.0);
    const Pose X_FS{on_corner, Vec3(0.003, 0.001, 0.05 + half_diagonal - 1e-3)};
    const DeepestPoint deepest = deepestPoint(block, cube, X_FS, 1e-6);
    EXPECT_NEAR(deepest.depth, 1e-3, 1e-6);
    EXPECT_LE(deepest.depth, 1e-3 + 1e-15);
}

TEST(DeepestPoint, IsExactAndQuickForFacesFlatOnEachOther) {
    // Truth: closed form (a plate sunk 0.1 mm into a block; all of its lower face is equally deep)
    const ExactMesh block = meshOf(shape::Box{0.1, 0.1, 0.1});
    const ExactMesh plate = meshOf(shape::Box{0.04, 0.04, 0.01});
    const DeepestPoint deepest = deepestPoint(block, plate, {.p = Vec3(0, 0, 0.05 + 0.005 - 1e-4)}, 1e-6);
    EXPECT_NEAR(deepest.depth, 1e-4, 1e-15);
    EXPECT_LT(deepest.pieces, 20000U);  // the face alone has 1.6e9 patches as small as the resolution
}

TEST(DeepestPoint, IsZeroForAGapHoweverSmall) {
    // Truth: closed form (faces 1 nm apart, and a peg in a bore with 10 µm of clearance)
    const ExactMesh block = meshOf(shape::Box{0.1, 0.1, 0.1});
    const ExactMesh plate = meshOf(shape::Box{0.04, 0.04, 0.01});
    const DeepestPoint flat = deepestPoint(block, plate, {.p = Vec3(0, 0, 0.05 + 0.005 + 1e-9)}, 1e-7);
    EXPECT_EQ(flat.depth, 0.0);
    EXPECT_LE(flat.uncertainty, 1e-7);
    EXPECT_LT(flat.pieces, 1000U);

    const ExactMesh bore(shape::tessellate(shape::BorePlate{0.06, 0.06, 0.03, 0.02002, 0.02, 0.0}, 1e-6));
    const ExactMesh peg(shape::tessellate(shape::Peg{0.02, 0.05, 0.0}, 1e-6));
    const DeepestPoint fit = deepestPoint(bore, peg, {.p = Vec3(0, 0, -0.015)}, 1e-6);
    EXPECT_EQ(fit.depth, 0.0);
    EXPECT_LE(fit.uncertainty, 1e-6);
    EXPECT_LT(fit.pieces, 100000U);
}

TEST(DeepestPoint, IsNeverLessThanTheDeepestOfManySamples) {
    // Truth: invariant (no sample of the surface is deeper than depth + uncertainty; one comes within the spacing)
    const ExactMesh plate = meshOf(shape::BorePlate{0.05, 0.05, 0.02, 0.0202, 0.015, 0.0005});
    const ExactMesh peg = meshOf(shape::Peg{0.02, 0.03, 0.001});
    const double resolution = 1e-5, spacing = 1e-3;
    Random random(7);
    int penetrating = 0;
    for (int i = 0; i < 16; ++i) {
        Pose X_FS = randomPose(random, 0.02);
        X_FS.p.z() -= 0.01;
        const DeepestPoint deepest = deepestPoint(plate, peg, X_FS, resolution);
        double sampled = 0.0;
        for (const Corners& t : peg.triangles()) {
            const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
            const int n = 1 + static_cast<int>(longest / spacing);
            for (int a = 0; a <= n; ++a) {
                for (int b = 0; a + b <= n; ++b) {
                    const Vec3 p = X_FS * (t[0] + (t[1] - t[0]) * a / n + (t[2] - t[0]) * b / n);
                    if (plate.contains(p)) sampled = std::max(sampled, plate.nearest(p).distance);
                }
            }
        }
        EXPECT_LE(deepest.uncertainty, resolution);
        EXPECT_LE(sampled, deepest.depth + deepest.uncertainty + 1e-15);
        EXPECT_GE(sampled, deepest.depth - spacing);
        penetrating += deepest.depth > 0.0 ? 1 : 0;
    }
    EXPECT_GT(penetrating, 8);
}

TEST(DeepestPoint, SaysHowUncertainItIsWhenItIsStoppedEarly) {
    // Truth: closed form (ball 2 mm deep in a block: the interval must hold the truth at every stop)
    const ExactMesh block = meshOf(shape::Box{0.1, 0.1, 0.1});
    const ExactMesh ball = meshOf(shape::Sphere{0.02});
    const Pose X_FS{.p = Vec3(0, 0, 0.05 + 0.01 - 0.002)};
    for (const std::size_t pieces : {1U, 10U, 100U, 1000U, 10000U}) {
        const DeepestPoint deepest = deepestPoint(block, ball, X_FS, 1e-9, pieces);
        EXPECT_LE(deepest.depth, 0.002 + 1e-15) << pieces;
        EXPECT_GE(deepest.depth + deepest.uncertainty, 0.002 - kChord) << pieces;
    }
}

}  // namespace
}  // namespace passung::truth
