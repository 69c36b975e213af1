#include "core/shape/thin_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/import/mesh_import.h"
#include "core/shell/point_shell.h"

namespace passung::shape {
namespace {

constexpr double kMm = 1e-3;

/// All parts of `other` added to `mesh`, moved by `by`.
void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& other, const Vec3& by) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + by);
    for (const geometry::Triangle& t : other.triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

std::vector<ThinFeature> thin(const geometry::TriangleMesh& mesh, double radius, ThinIn where) {
    const geometry::TriangleMesh sound = importer::repairMesh(mesh).mesh;
    return thinFeatures(sound, geometry::TriangleTree(sound), radius, where);
}

/// A block of 30 x 30 x 10 mm, top at z = 0, on which `shape` stands.
geometry::TriangleMesh blockWith(const Shape& shape, double height) {
    geometry::TriangleMesh mesh = tessellate(Box{30 * kMm, 30 * kMm, 10 * kMm}, 0.01 * kMm);
    for (Vec3& v : mesh.vertices) v.z() -= 5 * kMm;
    // Sunk in by half its height: a mesh of two solids that cross each other, as drawing programs write it.
    append(mesh, tessellate(shape, 0.01 * kMm), {2 * kMm, -3 * kMm, 0.25 * height});
    return mesh;
}

/// A bar of 30 mm along y whose cross-section is a wedge of `angle`, its edge up.
geometry::TriangleMesh wedge(double angle) {
    const double h = 15 * kMm, w = h * std::tan(0.5 * angle);
    geometry::TriangleMesh mesh;
    for (const double y : {-15 * kMm, 15 * kMm})
        for (const Vec3& v : {Vec3(0, y, 0), Vec3(-w, y, -h), Vec3(w, y, -h)}) mesh.vertices.push_back(v);
    mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
    return mesh;
}

TEST(ThinFeatures, APinIsThinIfItsDiameterIsBelowTwoRadii) {
    // Truth: closed form: a ball of radius r has room in a pin of diameter d if 2 r <= d, whatever the pin stands on.
    for (const double d : {0.1, 0.4, 1.0, 1.4}) {
        const geometry::TriangleMesh mesh = blockWith(Cylinder{d * kMm, 10 * kMm}, 10 * kMm);
        for (const double radius : {0.4, 0.6, 0.8}) {
            const auto found = thin(mesh, radius * kMm, ThinIn::Points);
            ASSERT_EQ(found.size(), d < 1.94 * radius ? 1u : 0u) << d << ' ' << radius;
            if (found.empty()) continue;
            EXPECT_EQ(found[0].kind, FeatureKind::Pin) << d << ' ' << radius;
            EXPECT_NEAR(found[0].size, d * kMm, 0.1 * d * kMm) << radius;
            EXPECT_NEAR(found[0].place.x(), 2 * kMm, d * kMm) << "told where it stands";
        }
    }
}

TEST(ThinFeatures, OnePinAmongManyEdgesIsFound) {
    // Truth: closed form: 400 posts of 3 mm have room for a ball of 0.6 mm, the pin of 0.8 mm beside them has not.
    geometry::TriangleMesh mesh = tessellate(Box{140 * kMm, 140 * kMm, 10 * kMm}, 0.01 * kMm);
    for (Vec3& v : mesh.vertices) v.z() -= 5 * kMm;
    const geometry::TriangleMesh post = tessellate(Box{3 * kMm, 3 * kMm, 8 * kMm}, 0.01 * kMm);
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k) append(mesh, post, {(i - 9.5) * 6.5 * kMm, (k - 9.5) * 6.5 * kMm, 3 * kMm});
    append(mesh, tessellate(Cylinder{0.8 * kMm, 8 * kMm}, 0.01 * kMm), {0, 0, 3 * kMm});
    const auto found = thin(mesh, 0.6 * kMm, ThinIn::Points);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, FeatureKind::Pin);
    EXPECT_LT(found[0].place.head<2>().norm(), 1 * kMm);
}

TEST(ThinFeatures, TheSearchEndsAfterItsWorkAndSaysWhatItLeftOut) {
    // Truth: invariant: a mesh of triangles through each other is thin wherever they lie. With room for all the work
    // the search leaves nothing out; with less it tells some of the same places, and how many it did not come to.
    Random random(1);
    geometry::TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 90; ++i)
        mesh.vertices.emplace_back(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    for (std::uint32_t i = 0; i < 90; i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
    const geometry::TriangleTree tree(mesh);
    SearchLimit all, some{.most_work = 10'000};
    const auto found = thinFeatures(mesh, tree, 0.05, ThinIn::Points, &all);
    const auto fewer = thinFeatures(mesh, tree, 0.05, ThinIn::Points, &some);
    EXPECT_EQ(all.left_out, 0u);
    EXPECT_GT(some.left_out, 100u);
    EXPECT_GT(some.work, some.most_work);
    EXPECT_GT(all.work, some.work);
    EXPECT_FALSE(found.empty());
    EXPECT_FALSE(fewer.empty());
}

TEST(ThinFeatures, AFinIsAWallOfItsThickness) {
    // Truth: closed form: as above, of the thickness; the block under it has room for every ball.
    for (const double t : {0.2, 0.5, 1.2}) {
        const geometry::TriangleMesh mesh = blockWith(Box{12 * kMm, t * kMm, 10 * kMm}, 10 * kMm);
        for (const auto where : {ThinIn::Points, ThinIn::Field}) {
            const auto found = thin(mesh, 0.75 * kMm, where);
            ASSERT_FALSE(found.empty()) << t;
            EXPECT_EQ(found[0].kind, FeatureKind::Wall) << t;
            EXPECT_NEAR(found[0].size, t * kMm, 0.1 * t * kMm);
        }
        EXPECT_TRUE(thin(mesh, 0.49 * t * kMm, ThinIn::Points).empty()) << t;
        EXPECT_TRUE(thin(mesh, 0.49 * t * kMm, ThinIn::Field).empty()) << t;
    }
}

TEST(ThinFeatures, BlocksAndTheirChamfersAreThickAndMeshesAgreeWithClosedForms) {
    // Truth: closed form: the thinnest place of each shape, told by its dimensions, is twice the radius that has room.
    struct Row {
        Shape shape;
        double thickness;
    };
    const Row rows[] = {{Box{20 * kMm, 30 * kMm, 4 * kMm}, 4 * kMm},
                        {Cylinder{5 * kMm, 20 * kMm}, 5 * kMm},
                        {Cylinder{20 * kMm, 3 * kMm}, 3 * kMm},
                        {BorePlate{60 * kMm, 60 * kMm, 30 * kMm, 50 * kMm, 25 * kMm, 0.5 * kMm}, 5 * kMm},
                        {SquarePeg{8 * kMm, 6 * kMm, 30 * kMm, 0.5 * kMm}, 6 * kMm}};
    for (const Row& row : rows) {
        const geometry::TriangleMesh mesh = tessellate(row.shape, 0.02 * kMm);
        EXPECT_TRUE(thinFeatures(row.shape, 0.49 * row.thickness, ThinIn::Field).empty()) << kindName(row.shape);
        EXPECT_TRUE(thin(mesh, 0.45 * row.thickness, ThinIn::Points).empty()) << kindName(row.shape);
        EXPECT_FALSE(thinFeatures(row.shape, 0.6 * row.thickness, ThinIn::Points).empty()) << kindName(row.shape);
        const auto found = thin(mesh, 0.6 * row.thickness, ThinIn::Points);
        ASSERT_FALSE(found.empty()) << kindName(row.shape);
        EXPECT_NEAR(found[0].size, row.thickness, 0.15 * row.thickness) << kindName(row.shape);
    }
}

TEST(ThinFeatures, AnEdgeIsToldIfItIsAcute) {
    // Truth: closed form: e = r / sin(angle / 2) exceeds 4.2 r below 27.5 degrees, at the ends of the bar's edge
    // (e² and r² add) below 28.4; a ball of 0.97 r counts as room, which is 26.6.
    for (const double degrees : {10.0, 20.0, 26.0, 29.0, 30.0, 32.5, 35.0, 37.5, 40.0, 45.0, 60.0, 90.0}) {
        const auto found = thin(wedge(degrees * std::numbers::pi / 180.0), 0.75 * kMm, ThinIn::Points);
        EXPECT_EQ(!found.empty(), degrees < 27.5) << degrees;
        for (const ThinFeature& feature : found) EXPECT_EQ(feature.kind, FeatureKind::Edge) << degrees;
    }
}

TEST(ThinFeatures, WhatIsThinOnASurfaceWithoutFacesIsRelief) {
    // Truth: closed form: a ball pressed to an ellipsoid of 40 x 40 x 4 mm has no flat or developed face; there is room
    // for no ball of 3 mm in it, and in its rim, round with b² / a = 0.2 mm, for one of 0.1 mm.
    geometry::TriangleMesh mesh = tessellate(Sphere{40 * kMm}, 0.001 * kMm);
    for (Vec3& v : mesh.vertices) v.z() *= 0.1;
    const auto found = thin(mesh, 3.0 * kMm, ThinIn::Points);
    EXPECT_FALSE(found.empty());
    for (const ThinFeature& feature : found) EXPECT_EQ(feature.kind, FeatureKind::Relief) << feature.size;
    EXPECT_TRUE(thin(mesh, 0.1 * kMm, ThinIn::Points).empty());
}

TEST(ThinFeatures, NoGapBetweenPointsOfAFaceIsWiderThanReckoned) {
    // Truth: dense geometry: the largest disc on a face without a sample, over a grid of 1/10 spacing, on parts of
    // several sizes. The share is what the study's check takes for a pin's radius.
    constexpr double kShare = 0.9;
    double worst = 0.0;
    for (const double side : {12.0, 20.0})
        for (const double spacing : {0.7, 1.0, 1.3}) {
            const shell::PointShell shell = shell::samplePoints(tessellate(Box{side, side, 4.0}, 0.01), spacing);
            std::vector<Vec3> face;
            for (const shell::SurfacePoint& p : shell.points)
                if (p.position.z() > 1.99) face.push_back(p.position);
            for (double x = -0.5 * side; x <= 0.5 * side; x += 0.1 * spacing)
                for (double y = -0.5 * side; y <= 0.5 * side; y += 0.1 * spacing) {
                    double nearest = 1e9;
                    for (const Vec3& p : face) nearest = std::min(nearest, std::hypot(p.x() - x, p.y() - y));
                    worst = std::max(worst, nearest / spacing);
                }
        }
    std::printf("largest disc without a sample: %.3f spacings\n", worst);
    EXPECT_LT(worst, kShare);
    EXPECT_GT(worst, 0.6 * kShare) << "reckoned with far more than there is";
}

}  // namespace
}  // namespace passung::shape
