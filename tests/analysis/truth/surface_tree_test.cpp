#include "analysis/truth/surface_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/base/random.h"
#include "core/shape/shape.h"

namespace passung::truth {
namespace {

constexpr double kStiffness = 1e9;

/// A ball that dips `depth` into the top face z = 0.05 of a cube of 0.1 m, off its middle.
struct DippedBall {
    static constexpr double kRadius = 0.01, kDepth = 1e-3;
    ExactMesh cube{shape::tessellate(shape::Box{0.1, 0.1, 0.1}, 1e-3)};
    ExactMesh ball{shape::tessellate(shape::Sphere{2 * kRadius}, 2e-6)};
    Pose X_FS{rotationFromVector({0.4, -0.2, 0.9}), Vec3(0.011, -0.007, 0.05 + kRadius - kDepth)};
};

TEST(SurfaceTree, PenaltyOfADippedBallIsItsSubmergedVolume) {
    // Truth: closed form. F = κ V of the cap, V = π d² (r - d/3), straight up, through the ball's middle. The chord
    // error of 2 µm lessens the depth of 1 mm by up to 0.2 % and the area with it, the force by up to 0.4 %; the
    // quadrature adds (0.2 mm / 4.4 mm)² / 24 < 0.01 %.
    const DippedBall s;
    const double d = DippedBall::kDepth;
    const double force = kStiffness * std::numbers::pi * d * d * (DippedBall::kRadius - d / 3.0);
    const Wrench wrench = SurfaceTree(s.ball).penaltyWrench({s.cube}, s.X_FS, kStiffness, 0.2e-3);
    EXPECT_NEAR(wrench.force.z(), force, 4.1e-3 * force);
    EXPECT_LT(wrench.force.head<2>().norm(), 1e-3 * force);
    EXPECT_LT(wrench.torque.norm(), 1e-3 * force * DippedBall::kRadius);
}

TEST(SurfaceTree, TorqueIsAboutTheOriginOfTheSurface) {
    // Truth: closed form. The same ball, its mesh shifted by c in its own frame: the force acts along the vertical
    // through the ball's middle, T = (R c) × F.
    DippedBall s;
    const Vec3 c(0.02, 0.03, -0.01);
    geometry::TriangleMesh shifted = shape::tessellate(shape::Sphere{2 * DippedBall::kRadius}, 2e-6);
    for (Vec3& v : shifted.vertices) v += c;
    const ExactMesh ball(shifted);
    s.X_FS.p -= s.X_FS.q * c;
    const Wrench wrench = SurfaceTree(ball).penaltyWrench({s.cube}, s.X_FS, kStiffness, 0.2e-3);
    const Vec3 torque = (s.X_FS.q * c).cross(wrench.force);
    EXPECT_GT(torque.norm(), 1e-2 * wrench.force.norm());
    EXPECT_LT((wrench.torque - torque).norm(), 1e-3 * wrench.force.norm() * DippedBall::kRadius);
}

TEST(SurfaceTree, SmallestDistanceBracketsTheDepthOfADippedBall) {
    // Truth: closed form. The ball's lowest point is 1 mm below the face; its chords are within 2 µm of it.
    const DippedBall s;
    const SmallestDistance found = SurfaceTree(s.ball).smallestDistance({s.cube}, s.X_FS, 0.5e-6);
    EXPECT_LE(found.uncertainty, 0.5e-6);
    EXPECT_GE(found.value, -DippedBall::kDepth - 1e-12);
    EXPECT_LE(found.value - found.uncertainty, -DippedBall::kDepth + 2e-6);
}

TEST(SurfaceTree, SmallestDistanceAgreesWithASearchOverAllTriangles) {
    // Truth: independent program (truth::deepestPoint, which begins at every triangle and knows no spheres). Both give
    // an interval that holds the same number, so the intervals meet.
    const ExactMesh cube(shape::tessellate(shape::Box{0.1, 0.1, 0.1}, 1e-3));
    const ExactMesh peg(shape::tessellate(shape::Peg{0.02, 0.06, 2e-3}, 20e-6));
    const SurfaceTree tree(peg);
    Random random(7);
    int inside = 0;
    for (int i = 0; i < 12; ++i) {
        const Pose X_FS{Quat(random.normal(), random.normal(), random.normal(), random.normal()).normalized(),
                        0.06 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))};
        const SmallestDistance found = tree.smallestDistance({cube}, X_FS, 20e-6);
        const truth::DeepestPoint deepest = truth::deepestPoint(cube, peg, X_FS, 20e-6);
        if (deepest.depth > 0.0) {
            ++inside;
            EXPECT_LE(-found.value, deepest.depth + deepest.uncertainty + 1e-12);
            EXPECT_GE(-found.value + found.uncertainty, deepest.depth - 1e-12);
        } else {
            EXPECT_GE(found.value, -1e-12);
        }
    }
    EXPECT_GE(inside, 3);
}

TEST(SurfaceTree, SmallestDistanceToAShapeIsItsClosedFormAlsoWhereFacesLieFlush) {
    // Truth: closed form. A peg of radius r, upright in a bore of radius R and moved sideways by e, reaches e + r - R
    // into the wall along a line; pressed onto the plate's face, its flat tip is as deep everywhere. Chords of both are
    // within 1 µm.
    const shape::Shape plate = shape::BorePlate{0.06, 0.06, 0.03, 0.021, 0.025, 0.0};
    const ExactMesh plate_mesh(shape::tessellate(plate, 1e-6));
    const ExactMesh peg(shape::tessellate(shape::Peg{0.02, 0.05, 0.0}, 1e-6));
    const Solid solid{plate_mesh, &plate, 1e-6};
    const SurfaceTree tree(peg);
    const double e = 0.9e-3;
    const SmallestDistance wall = tree.smallestDistance(solid, {Quat::Identity(), Vec3(e, 0.0, -0.01)}, 1e-6);
    EXPECT_NEAR(wall.value, -(e + 0.01 - 0.0105), 2e-6);
    const SmallestDistance face = tree.smallestDistance(solid, {Quat::Identity(), Vec3(0.005, 0.026, -e)}, 1e-6);
    EXPECT_NEAR(face.value, -e, 1e-9);
    EXPECT_LE(std::max(wall.uncertainty, face.uncertainty), 2e-6 + 1e-12);
}

}  // namespace
}  // namespace passung::truth
