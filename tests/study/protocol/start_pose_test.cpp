#include "study/protocol/start_pose.h"

#include <gtest/gtest.h>

#include <numbers>

namespace passung::protocol {
namespace {

constexpr double kMm = 1e-3;

scene::PartSpec part(const shape::Shape& shape, const Vec3& p_mm, const Quat& q = Quat::Identity()) {
    scene::PartSpec spec;
    spec.geometry = shape;
    spec.X_WP = {q, kMm * p_mm};
    return spec;
}

const shape::Shape kPlate = shape::BorePlate{0.060, 0.060, 0.030, 0.0202, 0.025, 0.0};
const shape::Shape kPeg = shape::Peg{0.020, 0.050, 0.0};

TEST(StartPose, DepthIsThatOfTheTipBelowThePlatesTop) {
    // Truth: closed form: a tip face 3 mm below the top, beside the bore, is 3 mm from the nearest way out.
    EXPECT_NEAR(startDepth(part(kPeg, {15, 0, -3}), part(kPlate, {0, 0, 0})), 3 * kMm, 1e-9);
    EXPECT_NEAR(startDepth(part(kPeg, {25, 0, -3}), part(kPlate, {10, 0, 0})), 3 * kMm, 1e-9);
    EXPECT_EQ(startDepth(part(kPeg, {15, 0, 0}), part(kPlate, {0, 0, 0})), 0.0);
    EXPECT_EQ(startDepth(part(kPeg, {15, 0, 30}), part(kPlate, {0, 0, 0})), 0.0);
}

TEST(StartPose, APegInItsBoreTouchesNothing) {
    // Truth: closed form: 0.1 mm of clearance all round; 0.15 mm aside it is 0.05 mm deep in the wall.
    EXPECT_EQ(startDepth(part(kPeg, {0, 0, -20}), part(kPlate, {0, 0, 0})), 0.0);
    // A lower bound: the deepest place of a round face lies up to half a segment from the next point.
    const double deep = startDepth(part(kPeg, {0.15, 0, -20}), part(kPlate, {0, 0, 0}));
    EXPECT_LE(deep, 0.05 * kMm + 1e-9);
    EXPECT_GT(deep, 0.03 * kMm);
}

TEST(StartPose, AnObstacleWithinAFaceIsFound) {
    // Truth: closed form: a ball of 2 mm whose centre lies on a face of the held box is 1 mm deep in it, and no point
    // that the box has on its edges comes near it.
    const shape::Shape box = shape::Box{0.040, 0.040, 0.040};
    const Quat turned(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
    EXPECT_NEAR(startDepth(part(box, {0, 0, 20}, turned), part(shape::Sphere{0.002}, {0.3, 0.4, 0})), kMm, 0.05 * kMm);
}

TEST(StartPose, ASheetThatCutsThePegIsFound) {
    // Truth: closed form: the sheet has no inside, but its points within the peg are up to 3 mm from the tip face.
    EXPECT_NEAR(startDepth(part(kPeg, {0, 0, -3}), part(shape::Sheet{0.1, 0.1}, {0, 0, 0})), 3 * kMm, 1e-9);
    EXPECT_EQ(startDepth(part(kPeg, {0, 0, 1}), part(shape::Sheet{0.1, 0.1}, {0, 0, 0})), 0.0);
}

TEST(StartPose, NothingIsSaidOfMeshes) {
    // Truth: invariant: nothing is known of a mesh before it is loaded.
    scene::PartSpec mesh;
    mesh.geometry = scene::MeshFile{"none.stl", kMm};
    EXPECT_EQ(startDepth(part(kPeg, {0, 0, -3}), mesh), 0.0);
}

}  // namespace
}  // namespace passung::protocol
