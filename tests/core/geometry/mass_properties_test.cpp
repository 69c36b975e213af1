#include "core/geometry/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/geometry/triangle_tree.h"
#include "core/import/mesh_import.h"
#include "core/shape/shape.h"

namespace passung::geometry {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSteel = 7850.0;  // [kg/m³]

/// Triangles turned and moved as a rigid body.
TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
    for (Vec3& vertex : mesh.vertices) vertex = pose * vertex;
    return mesh;
}

void expectNear(const MassProperties& found, const MassProperties& truth, double share) {
    const double size = std::sqrt(truth.inertia.trace() / truth.mass);
    EXPECT_NEAR(found.mass / truth.mass, 1.0, share);
    EXPECT_LT((found.centre - truth.centre).norm(), share * size);
    EXPECT_LT((found.inertia - truth.inertia).norm(), share * truth.inertia.norm());
}

TEST(MassProperties, AreThoseOfABoxWhereverItsFrameIs) {
    // Truth: closed form, turned and moved by hand: I = m/12 (b² + c²) about the first axis; R I Rᵀ.
    const double a = 0.02, b = 0.03, c = 0.05, mass = kSteel * a * b * c;
    const Mat3 own = mass / 12.0 * Vec3(b * b + c * c, c * c + a * a, a * a + b * b).asDiagonal().toDenseMatrix();
    const TriangleMesh mesh = shape::tessellate(shape::Box{a, b, c}, 1e-5);
    Random random(1);
    for (int i = 0; i < 50; ++i) {
        const Pose X{rotationFromVector(3.0 * Vec3(random.normal(), random.normal(), random.normal())),
                     Vec3(random.normal(), random.normal(), random.normal())};
        const Mat3 R = X.q.toRotationMatrix();
        expectNear(massOf(moved(mesh, X), kSteel), {mass, X.p, R * own * R.transpose()}, 1e-11);
    }
}

TEST(MassProperties, ComeNearerToThoseOfRoundBodiesAsTrianglesGetFiner) {
    // Truth: closed form (sphere, cylinder, torus; a cone as a peg that is chamfered to its point has a cylinder above
    // it, so that a cone is made of triangles here). Polygons of n corners in a circle lack 2π²/(3 n²) of its area.
    const double r = 0.01, l = 0.04, R = 0.03;
    const double ball = kSteel * 4.0 / 3.0 * kPi * r * r * r, rod = kSteel * kPi * r * r * l;
    const double ring = kSteel * 2.0 * kPi * kPi * R * r * r;
    const MassProperties sphere{ball, Vec3::Zero(), 0.4 * ball * r * r * Mat3::Identity()};
    const double across = rod * (r * r / 4.0 + l * l / 12.0), side = ring * (R * R / 2.0 + 5.0 / 8.0 * r * r);
    const MassProperties cylinder{rod, Vec3::Zero(), Mat3(Vec3(across, across, rod * r * r / 2.0).asDiagonal())};
    const MassProperties torus{ring, Vec3::Zero(), Mat3(Vec3(side, side, ring * (R * R + 0.75 * r * r)).asDiagonal())};
    const auto check = [](const shape::Shape& shape, const MassProperties& truth) {
        double before = 1.0;
        for (const double chord : {1e-4, 1e-5, 1e-6}) {
            const double off = std::abs(massOf(shape::tessellate(shape, chord), kSteel).mass / truth.mass - 1.0);
            EXPECT_LT(off, 0.2 * before) << shape::kindName(shape) << " " << chord;
            before = off;
        }
        expectNear(massOf(shape::tessellate(shape, 1e-7), kSteel), truth, 1e-4);
    };
    check(shape::Sphere{2.0 * r}, sphere);
    check(shape::Cylinder{2.0 * r, l}, cylinder);
    check(shape::Torus{2.0 * R, 2.0 * r}, torus);

    constexpr std::uint32_t kCorners = 4000;
    TriangleMesh cone{{Vec3(0, 0, l), Vec3::Zero()}, {}};
    for (std::uint32_t i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * kPi * i / kCorners;
        cone.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
        const std::uint32_t here = 2 + i, next = 2 + (i + 1) % kCorners;
        cone.triangles.push_back({here, next, 0});
        cone.triangles.push_back({next, here, 1});
    }
    const double m = kSteel * kPi * r * r * l / 3.0, tilted = m * (3.0 / 20.0 * r * r + 3.0 / 80.0 * l * l);
    expectNear(massOf(cone, kSteel), {m, Vec3(0, 0, l / 4.0), Mat3(Vec3(tilted, tilted, 0.3 * m * r * r).asDiagonal())},
               1e-6);
}

TEST(MassProperties, OfAScannedBodyAreWhatRandomPointsInItSay) {
    // Truth: independent program (Monte Carlo by winding numbers, 400 000 points in the bounds; a share p of hits has
    // the deviation √(p(1-p)/n), about 0.15 % of the volume here; moments likewise): four deviations.
    auto imported = importer::importMesh(std::string(PASSUNG_SOURCE_DIR) + "/tests/data/bunny.off", 1.0);
    ASSERT_TRUE(imported);
    const TriangleMesh& mesh = imported->mesh;
    const MassProperties body = massOf(mesh, kSteel);
    EXPECT_NEAR(body.mass / kSteel / imported->report.volume, 1.0, 1e-9);
    const TriangleTree tree(mesh);
    const Bounds bounds = boundsOf(mesh);
    Random random(7);
    constexpr int kPoints = 400'000;
    double inside = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int i = 0; i < kPoints; ++i) {
        const Vec3 p =
            bounds.low + bounds.size().cwiseProduct(Vec3(random.uniform(), random.uniform(), random.uniform()));
        if (!tree.inside(p)) continue;
        inside += 1.0;
        first += p;
        second += (p - body.centre) * (p - body.centre).transpose();
    }
    const double weight = kSteel * bounds.size().prod() / kPoints;
    EXPECT_NEAR(weight * inside / body.mass, 1.0, 0.006);
    EXPECT_LT((first / inside - body.centre).norm(), 0.003 * bounds.size().norm());
    const Mat3 inertia = weight * (second.trace() * Mat3::Identity() - second);
    EXPECT_LT((inertia - body.inertia).norm(), 0.01 * body.inertia.norm());
}

TEST(MassProperties, ObeyTheParallelAxisAndAddUp) {
    // Truth: closed form. Two boxes side by side are one box; a box less its half is the other half.
    const MassProperties half = massOf(shape::tessellate(shape::Box{0.02, 0.03, 0.05}, 1e-5), kSteel);
    MassProperties left = half, right = half;
    left.centre = Vec3(-0.01, 0, 0);
    right.centre = Vec3(0.01, 0, 0);
    const MassProperties whole = massOf(shape::tessellate(shape::Box{0.04, 0.03, 0.05}, 1e-5), kSteel);
    expectNear(together(left, right), whole, 1e-12);
    expectNear(together(whole, {-left.mass, left.centre, -left.inertia}), right, 1e-12);
    // About a corner: m/3 (b² + c²), and products -m/4 a b.
    const double m = whole.mass, a = 0.04, b = 0.03, c = 0.05;
    Mat3 corner;
    corner << m / 3 * (b * b + c * c), -m / 4 * a * b, -m / 4 * a * c,  //
        -m / 4 * a * b, m / 3 * (c * c + a * a), -m / 4 * b * c,        //
        -m / 4 * a * c, -m / 4 * b * c, m / 3 * (a * a + b * b);
    EXPECT_LT((inertiaAbout(whole, Vec3(-0.02, -0.015, -0.025)) - corner).norm(), 1e-12 * corner.norm());
}

TEST(MassProperties, OfNothingAreNone) {
    // Truth: closed form. A flat body encloses nothing; one turned inside out encloses less than that.
    EXPECT_EQ(massOf(TriangleMesh{}, kSteel).mass, 0.0);
    const TriangleMesh flat{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}};
    EXPECT_EQ(massOf(flat, kSteel).mass, 0.0);
    TriangleMesh turned = shape::tessellate(shape::Box{0.02, 0.03, 0.05}, 1e-5);
    for (Triangle& t : turned.triangles) std::swap(t[0], t[1]);
    EXPECT_LT(massOf(turned, kSteel).mass, 0.0);
}

}  // namespace
}  // namespace passung::geometry
