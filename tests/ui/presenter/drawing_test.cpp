#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/model/shape.h"
#include "ui/presenter/pointer_motion.h"
#include "ui/presenter/shaded_mesh.h"

namespace passung {
namespace {

using namespace presenter;

Camera camera() {
    Camera c;
    const Vec3 back = Vec3(0.3, -1.0, 0.6).normalized();
    const Vec3 right = Vec3::UnitZ().cross(back).normalized();
    Mat3 axes;
    axes << right, back.cross(right), back;
    c.X_WC = {Quat(axes), 0.4 * back};
    return c;
}

/// Where a point is in a picture of this height, from its middle: right and down [px].
Eigen::Vector2d pixelOf(const Camera& c, double height, const Vec3& p_W) {
    const Vec3 p = c.X_WC.inverse() * p_W;
    const double scale = 0.5 * height / std::tan(0.5 * c.opening);
    return {scale * p.x() / -p.z(), -scale * p.y() / -p.z()};
}

TEST(PointerMotion, APartThatIsDraggedSidewaysStaysUnderThePointer) {
    // Truth: closed form, the perspective projection.
    const Camera c = camera();
    const PartMotion motion = dragMotion(c, 720.0, DragPlane::Upright, 40.0, 0.0);
    const Eigen::Vector2d at = pixelOf(c, 720.0, motion.way);
    EXPECT_NEAR(at.x(), 40.0, 1e-6);
    EXPECT_NEAR(at.y(), 0.0, 1e-6);
    EXPECT_TRUE(motion.turn.isZero(0.0));
}

TEST(PointerMotion, EveryPlaneKeepsToItsDirections) {
    // Truth: invariant. Upright: no way towards the person; ground: none upwards; away is away.
    const Camera c = camera();
    const PartMotion up = dragMotion(c, 720.0, DragPlane::Upright, 0.0, -30.0);
    EXPECT_GT(up.way.z(), 0.0);
    EXPECT_NEAR(up.way.head<2>().norm(), 0.0, 1e-15);
    const PartMotion away = dragMotion(c, 720.0, DragPlane::Ground, 0.0, -30.0);
    EXPECT_NEAR(away.way.z(), 0.0, 1e-15);
    EXPECT_GT((c.X_WC.p + away.way).norm(), 0.0);
    EXPECT_LT(away.way.dot(c.X_WC.p), 0.0);
    EXPECT_LT(wheelMotion(c, DragPlane::Upright, 1.0).way.dot(c.X_WC.p), 0.0);
    const PartMotion turn = dragMotion(c, 720.0, DragPlane::Turn, 50.0, 0.0);
    EXPECT_TRUE(turn.way.isZero(0.0));
    EXPECT_GT(turn.turn.z(), 0.0);  // its front goes with the pointer
    HeldKeys keys;
    keys.move = Vec3(0, -1, 0);
    EXPECT_LT(keyMotion(c, keys, 0.1).way.z(), 0.0);
}

TEST(ShadedMesh, ACylinderIsSmoothAroundAndHasSharpRims) {
    // Truth: closed form. Normals of the mantle are radial to within half a segment, those of the caps axial; none
    // between.
    const model::TriangleMesh mesh = model::tessellate(model::Cylinder{0.02, 0.05}, 1e-5);
    const ShadedMesh shaded = shade(mesh);
    ASSERT_EQ(shaded.indices.size(), 3 * mesh.triangles.size());
    int mantle = 0, caps = 0;
    for (const auto& vertex : shaded.vertices) {
        const Vec3 n(vertex.normal[0], vertex.normal[1], vertex.normal[2]);
        const Vec3 p(vertex.position_mm[0], vertex.position_mm[1], vertex.position_mm[2]);
        EXPECT_NEAR(n.norm(), 1.0, 1e-5);
        if (std::abs(n.z()) > 0.99) {
            ++caps;
            continue;
        }
        ++mantle;
        EXPECT_NEAR(n.z(), 0.0, 1e-5);
        EXPECT_GT(n.head<2>().dot(p.head<2>().normalized()), 0.999);
    }
    EXPECT_GT(mantle, 20);
    EXPECT_GT(caps, 20);
    EXPECT_NEAR(static_cast<double>(shaded.high_mm[2]), 25.0, 1e-4);
}

TEST(ShadedMesh, ABoxHasThreeNormalsAtEveryCorner) {
    // Truth: closed form.
    const ShadedMesh shaded = shade(model::tessellate(model::Box{0.02, 0.03, 0.04}, 1e-4));
    EXPECT_EQ(shaded.vertices.size(), 24u);
}

}  // namespace
}  // namespace passung
