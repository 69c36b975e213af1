#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/shape/shape.h"
#include "ui/presenter/drawn_scene.h"
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
    const double coarse = keyMotion(c, keys, 0.1).way.norm();
    keys.fine = true;
    EXPECT_NEAR(keyMotion(c, keys, 0.1).way.norm(), 0.1 * coarse, 1e-12);
}

TEST(ShadedMesh, ACylinderIsSmoothAroundAndHasSharpRims) {
    // Truth: closed form. Normals of the mantle are radial to within half a segment, those of the caps axial; none
    // between.
    const geometry::TriangleMesh mesh = shape::tessellate(shape::Cylinder{0.02, 0.05}, 1e-5);
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
    const ShadedMesh shaded = shade(shape::tessellate(shape::Box{0.02, 0.03, 0.04}, 1e-4));
    EXPECT_EQ(shaded.vertices.size(), 24u);
}

/// A scene of a plate (target) and a held peg.
plan::Condition conditionOf(decltype(plan::Task::form) form) {
    plan::Condition condition;
    scene::PartSpec plate, peg;
    plate.name = "plate";
    plate.geometry = shape::Shape(shape::Box{0.06, 0.06, 0.02});
    plate.X_WP = {Quat::Identity(), Vec3(0.1, 0.0, 0.0)};
    peg.name = "peg";
    peg.held = true;
    peg.geometry = shape::Shape(shape::Cylinder{0.02, 0.05});
    peg.shown_offset = Vec3(0.0, 0.003, 0.0);
    condition.scene.parts = {plate, peg};
    condition.task.target = "plate";
    condition.task.form = std::move(form);
    return condition;
}

Vec3 middleOf(const Mark& mark) {
    Vec3 middle;
    for (std::size_t i = 0; i < 3; ++i)
        middle[static_cast<int>(i)] = 0.5e-3 * static_cast<double>(mark.mesh->low_mm[i] + mark.mesh->high_mm[i]);
    return mark.X_W * middle;
}

std::vector<Mark> marksOf(decltype(plan::Task::form) form) {
    SceneArtist artist;
    const auto scene = artist.draw(conditionOf(std::move(form)), {});
    EXPECT_TRUE(scene);
    return scene ? (*scene)->marks : std::vector<Mark>{};
}

TEST(SceneArtist, TheCameraStandsWhereTheStudyPutsIt) {
    // Truth: closed form. Its axis runs through what it looks at, the picture's upward direction shows no tilt; what is
    // not said is such that a sphere about all parts fits between the picture's lower and upper edge.
    SceneArtist artist;
    plan::View look;
    look.camera_from = {-1.0, -2.0, 2.0};
    look.camera_target = Vec3(0.02, 0.01, 0.03);
    look.camera_distance = 0.3;
    look.camera_opening = 0.4;
    look.light_from = Vec3(0, 0, 2);
    const auto scene = artist.draw(conditionOf(plan::PegInHoleTask{}), look);
    ASSERT_TRUE(scene);
    const Camera& camera = (*scene)->camera;
    EXPECT_NEAR((camera.X_WC.p - Vec3(0.02 - 0.1, 0.01 - 0.2, 0.03 + 0.2)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((camera.X_WC.q * -Vec3::UnitZ() - Vec3(1, 2, -2) / 3.0).norm(), 0.0, 1e-12);
    EXPECT_NEAR((camera.X_WC.q * Vec3::UnitX()).z(), 0.0, 1e-12) << "the horizon is level";
    EXPECT_GT((camera.X_WC.q * Vec3::UnitY()).z(), 0.0);
    EXPECT_EQ(camera.opening, 0.4);
    EXPECT_EQ((*scene)->light_from, Vec3::UnitZ());

    look.camera_distance.reset();
    look.camera_from = Vec3::UnitZ();  // straight from above
    const auto above = artist.draw(conditionOf(plan::PegInHoleTask{}), look);
    ASSERT_TRUE(above);
    const Camera& down = (*above)->camera;
    EXPECT_NEAR((down.X_WC.q * -Vec3::UnitZ() + Vec3::UnitZ()).norm(), 0.0, 1e-12);
    for (const DrawnPart& part : (*above)->parts)
        for (const auto& vertex : part.mesh->vertices) {
            const auto& p = vertex.position_mm;
            const Vec3 seen = down.X_WC.inverse() * (part.X_W * (1e-3 * Vec3(p[0], p[1], p[2])));
            EXPECT_LT(std::abs(std::atan2(seen.y(), -seen.z())), 0.2);
            EXPECT_TRUE(-seen.z() > down.near && -seen.z() < down.far);
        }
}

TEST(ShadedMesh, KnowsWhetherItsInsideCanBeSeen) {
    // Truth: closed form: a box is closed, without a triangle or turned inside out it is not.
    geometry::TriangleMesh box = shape::tessellate(shape::Box{0.02, 0.03, 0.04}, 1e-4);
    EXPECT_FALSE(shade(box).two_sided);
    for (const auto& shape : {shape::Shape(shape::Torus{0.1, 0.02}), shape::Shape(shape::BorePlate{.width = 0.06,
                                                                     .depth = 0.06,
                                                                     .height = 0.03,
                                                                     .bore_diameter = 0.02,
                                                                     .bore_depth = 0.02,
                                                                     .chamfer = 0.001})})
        EXPECT_FALSE(shade(shape::tessellate(shape, 1e-4)).two_sided) << shape::kindName(shape);
    EXPECT_TRUE(shade(shape::tessellate(shape::Sheet{0.02, 0.03}, 1e-4)).two_sided);
    geometry::TriangleMesh inside_out = box;
    for (auto& [a, b, c] : inside_out.triangles) std::swap(b, c);
    EXPECT_TRUE(shade(inside_out).two_sided);
    box.triangles.pop_back();
    EXPECT_TRUE(shade(box).two_sided);
}

TEST(TaskMarks, EveryTypeOfTrialShowsWhatItAsksFor) {
    // Truth: closed form. Rings stand at the mouths, a contour along its points in the target's frame, a placed part
    // where it would be drawn, that is, moved by the offset at which it is shown.
    const auto bore = marksOf(plan::PegInHoleTask{});
    ASSERT_EQ(bore.size(), 1u);
    EXPECT_NEAR((middleOf(bore[0]) - Vec3(0.1, 0, 0)).norm(), 0.0, 1e-6);
    const auto passage = marksOf(plan::NarrowPassageTask{.length = 0.02, .width = 0.03});
    ASSERT_EQ(passage.size(), 2u);
    EXPECT_NEAR((middleOf(passage[1]) - Vec3(0.1, 0, -0.02)).norm(), 0.0, 1e-6);
    const auto contour =
        marksOf(plan::ContourFollowingTask{.points = {{-0.02, 0, 0.01}, {0.02, 0, 0.01}, {0.02, 0.02, 0.01}}});
    ASSERT_EQ(contour.size(), 1u);
    EXPECT_NEAR((middleOf(contour[0]) - Vec3(0.1, 0.01, 0.01)).norm(), 0.0, 1e-6);
    const auto placement = marksOf(plan::FreePlacementTask{.X_WGoal = {Quat::Identity(), Vec3(0.2, 0.0, 0.05)}});
    ASSERT_EQ(placement.size(), 1u);
    EXPECT_TRUE(placement[0].pale);
    EXPECT_NEAR((middleOf(placement[0]) - Vec3(0.2, 0.003, 0.05)).norm(), 0.0, 1e-6);
    EXPECT_TRUE(marksOf(plan::DiscriminationPairTask{}).empty());
}

TEST(TaskMarks, ALineIsAsThickAsItIsToBeAllAlong) {
    // Truth: closed form. Of a line along x, every vertex lies on its surface, within the error of the tessellation.
    const double radius = 0.5e-3;
    for (const Vec3& v : lineThrough({{0, 0, 0}, {0.03, 0, 0}}, radius).vertices) {
        const double beyond = std::max({0.0, -v.x(), v.x() - 0.03});
        const double away = std::hypot(beyond, v.tail<2>().norm());
        EXPECT_LE(away, 1.0001 * radius);
        EXPECT_TRUE(away > 0.85 * radius || (v.x() >= 0 && v.x() <= 0.03)) << v.transpose();
    }
}

}  // namespace
}  // namespace passung
