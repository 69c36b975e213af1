#include "core/geometry/surface_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/shape/shape.h"

namespace passung::geometry {
namespace {

/// A strip of 10 × 1 in the plane z = 0, cut into 20 triangles.
TriangleMesh strip() {
    TriangleMesh mesh;
    for (int i = 0; i <= 10; ++i)
        for (int k = 0; k <= 1; ++k) mesh.vertices.push_back(Vec3(i, k, 0.0));
    for (std::uint32_t i = 0; i < 20; i += 2) {
        mesh.triangles.push_back({i, i + 2, i + 1});
        mesh.triangles.push_back({i + 1, i + 2, i + 3});
    }
    return mesh;
}

/// The strip rolled about the y axis, its triangles flat still.
TriangleMesh rolled(double turn) {
    TriangleMesh mesh = strip();
    Vec3 at = Vec3::Zero();
    for (std::size_t i = 0; i <= 10; ++i) {
        mesh.vertices[2 * i] = at;
        mesh.vertices[2 * i + 1] = at + Vec3::UnitY();
        const double angle = turn * static_cast<double>(i);
        at += Vec3(std::cos(angle), 0.0, std::sin(angle));
    }
    return mesh;
}

TEST(SurfaceWalk, FollowsAStraightLineOfTheUnrolledSurface) {
    // Truth: closed form. A rolled strip can be laid flat: the way from (0.1, 0.2) by (2.5, 0.5) ends at (2.6, 0.7),
    // which is 0.6 along the third of its faces. 1e-5: some roundings of floats of size 10.
    for (const double turn : {0.0, 0.3, -1.2, 1.5}) {
        const TriangleMesh mesh = rolled(turn);
        const SurfaceWalk walk(mesh);
        const auto end = walk.moved({0, Eigen::Vector3f(0.1f, 0.2f, 0.0f)}, Eigen::Vector3f(2.5f, 0.5f, 0.0f));
        const Vec3 truth = mesh.vertices[4] + 0.6 * (mesh.vertices[6] - mesh.vertices[4]) + 0.7 * Vec3::UnitY();
        EXPECT_LT((end.position.cast<double>() - truth).norm(), 1e-5) << turn;
        EXPECT_EQ(end.triangle, 5u) << turn;
    }
}

TEST(SurfaceWalk, TakesOnlyThePartOfAStepThatLiesInThePlane) {
    // Truth: closed form.
    const SurfaceWalk walk(strip());
    const auto end = walk.moved({0, Eigen::Vector3f(0.1f, 0.2f, 0.0f)}, Eigen::Vector3f(0.2f, 0.1f, 5.0f));
    EXPECT_LT((end.position - Eigen::Vector3f(0.3f, 0.3f, 0.0f)).norm(), 1e-6f);
    EXPECT_EQ(end.triangle, 0u);
}

TEST(SurfaceWalk, EndsAtABorderAndAtAnEdgeOfThreeTriangles) {
    // Truth: closed form. The strip's border is y = 1; a third triangle at x = 1 ends the way there.
    const Eigen::Vector3f start(0.1f, 0.2f, 0.0f);
    const auto at_border = SurfaceWalk(strip()).moved({0, start}, Eigen::Vector3f(0.0f, 2.0f, 0.0f));
    EXPECT_LT((at_border.position - Eigen::Vector3f(0.1f, 1.0f, 0.0f)).norm(), 1e-6f);
    TriangleMesh mesh = strip();
    mesh.vertices.push_back(Vec3(1.0, 0.5, 1.0));
    mesh.triangles.push_back({2, 3, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    const auto at_edge = SurfaceWalk(mesh).moved({0, start}, Eigen::Vector3f(3.0f, 0.0f, 0.0f));
    EXPECT_LT((at_edge.position - Eigen::Vector3f(1.0f, 0.2f, 0.0f)).norm(), 1e-6f);
    // A triangle without area has no plane to go along.
    TriangleMesh flat;
    flat.vertices = {Vec3::Zero(), Vec3::UnitX(), Vec3(2.0, 0.0, 0.0)};
    flat.triangles = {{0, 1, 2}};
    const auto nowhere = SurfaceWalk(flat).moved({0, Eigen::Vector3f::Zero()}, Eigen::Vector3f(1.0f, 1.0f, 0.0f));
    EXPECT_EQ(nowhere.position, Eigen::Vector3f::Zero().eval());
}

TEST(SurfaceWalk, StaysOnTheSurfaceInEveryDirection) {
    // Truth: closed form of the sphere; its triangles lie at most the chord error below it.
    const double radius = 0.02, chord = 20e-6;
    const shape::Shape ball = shape::Sphere{2.0 * radius};
    const TriangleMesh mesh = shape::tessellate(ball, chord);
    const SurfaceWalk walk(mesh);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 7) {
        const Vec3 middle = (mesh.vertices[mesh.triangles[t][0]] + mesh.vertices[mesh.triangles[t][1]] +
                             mesh.vertices[mesh.triangles[t][2]]) /
                            3.0;
        const auto [u, v] = walk.axes(t);
        ASSERT_NEAR(u.dot(v), 0.0f, 1e-6f);
        ASSERT_NEAR(u.norm() * v.norm(), 1.0f, 1e-6f);
        for (int i = 0; i < 12; ++i) {
            const auto angle = static_cast<float>(i * std::numbers::pi / 6.0);
            const Eigen::Vector3f step = 1e-3f * (std::cos(angle) * u + std::sin(angle) * v);
            const auto end = walk.moved({t, middle.cast<float>()}, step);
            const double depth = -shape::signedDistance(ball, end.position.cast<double>());
            ASSERT_GT(depth, -1e-8);
            ASSERT_LT(depth, chord + 1e-8);
            // The way bends with the surface: its ends are nearer to each other than it is long, by far less than a
            // tenth on this ball.
            const double chord_length = (end.position.cast<double>() - middle).norm();
            ASSERT_LT(chord_length, 1e-3 * (1.0 + 1e-4));
            ASSERT_GT(chord_length, 0.9e-3);
        }
    }
}

}  // namespace
}  // namespace passung::geometry
