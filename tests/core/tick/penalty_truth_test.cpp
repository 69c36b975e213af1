#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"
#include "core/tick/penalty.h"
#include "tests/support/submerged.h"

namespace passung {
namespace {

using scene::Part;

/// Area-weighted penalty of `shell` at X_WS against `field` at X_WF, about the origin of S.
Wrench areaPenalty(const Part& field, const Pose& X_WF, const Part& shell, const Pose& X_WS, double kappa) {
    contact::QueryWorkspace workspace(shell.shell->nodes().size());
    contact::ContactManifold manifold(shell.shell->points().size());
    contact::queryContacts(*field.field, X_WF, *shell.shell, X_WS, {}, workspace, manifold);
    scene::ContactSpec contact;
    contact.variant = scene::PenaltyVariant::AreaWeighted;
    contact.area_stiffness = kappa;
    return tick::penaltyWrench(contact, manifold, X_WS.p);
}

Part part(const shape::Shape& shape, const scene::PartNeeds& needs) {
    scene::PartSpec spec;
    spec.name = shape::kindName(shape);
    spec.geometry = shape;
    auto built = scene::buildPart(spec, needs);
    EXPECT_TRUE(built);
    return std::move(*built);
}

/// A box so large that its top face (z = 0 after X_WF) is a plane for the small bodies above it.
const Pose kTableTop{Quat::Identity(), Vec3(0, 0, -0.04)};
Part table() { return part(shape::Box{0.12, 0.12, 0.08}, {.field = true, .cell = 1e-3}); }

constexpr double kKappa = 1e9;

TEST(PenaltyTruth, SphereIntoPlaneFeelsItsSubmergedVolume) {
    // Truth: closed form. F = κ π h² (3R - h) / 3 along the normal, no torque; 1 %.
    const Part plane = table();
    const Part ball = part(shape::Sphere{0.04}, {.shell = true, .spacing = 0.5e-3});
    const double R = 0.02, h = 0.002;
    const Wrench w = areaPenalty(plane, kTableTop, ball, {Quat::Identity(), Vec3(0.001, 0.0003, R - h)}, kKappa);
    const double expected = kKappa * std::numbers::pi * h * h * (3 * R - h) / 3;
    EXPECT_NEAR(w.force.z(), expected, 0.01 * expected);
    EXPECT_LT(std::hypot(w.force.x(), w.force.y()), 0.01 * expected);
    EXPECT_LT(w.torque.norm(), 0.01 * expected * R);
}

TEST(PenaltyTruth, TiltedBoxIntoPlaneFeelsItsSubmergedVolumeAtItsCentroid) {
    // Truth: closed form. A box tilted about y by α with one edge below the plane: the wet part is a triangular prism
    // of depth d at the edge, legs d/sin α and d/cos α, so V = w d² / (2 sin α cos α); its centroid is that of the
    // triangle.
    const Part plane = table();
    const Part box = part(shape::Box{0.03, 0.02, 0.03}, {.shell = true, .spacing = 0.5e-3});
    const double alpha = 0.5, d = 0.003;
    const Quat q(Eigen::AngleAxisd(alpha, Vec3::UnitY()));
    const Vec3 lowest = q * Vec3(0.015, 0, -0.015);  // the edge that dips in
    const Pose X_WS{q, Vec3(0, 0, -d - lowest.z())};
    const Wrench w = areaPenalty(plane, kTableTop, box, X_WS, kKappa);
    const double volume = 0.02 * d * d / (2 * std::sin(alpha) * std::cos(alpha));
    EXPECT_NEAR(w.force.z(), kKappa * volume, 0.01 * kKappa * volume);
    EXPECT_LT(std::hypot(w.force.x(), w.force.y()), 0.01 * kKappa * volume);
    const Vec3 a = X_WS * Vec3(0.015, 0, -0.015);
    const Vec3 b = a + q * Vec3(-d / std::sin(alpha), 0, 0);  // where the bottom face leaves the plane
    const Vec3 c = a + q * Vec3(0, 0, d / std::cos(alpha));   // where the side face leaves it
    const Vec3 lever = (a + b + c) / 3.0 - X_WS.p;
    const Vec3 torque = lever.cross(Vec3(0, 0, kKappa * volume));
    EXPECT_NEAR(w.torque.y(), torque.y(), 0.01 * std::abs(torque.y()));
}

TEST(PenaltyTruth, AnyBodyAtAnyPoseFeelsItsSubmergedVolumeAtItsCentroid) {
    // Truth: closed form (Archimedes, by the divergence theorem): F = κ V n through the centroid of V; V by exact
    // clipping.
    const Part plane = table();
    Random random(17);
    for (const shape::Shape& shape :
         {shape::Shape(shape::Peg{0.02, 0.03, 0.002}), shape::Shape(shape::Box{0.02, 0.03, 0.025}),
          shape::Shape(shape::BorePlate{0.03, 0.03, 0.02, 0.012, 0.015, 0.001})}) {
        const Part body = part(shape, {.shell = true, .spacing = 0.6e-3});
        for (int i = 0; i < 10; ++i) {
            const Quat q = rotationFromVector(2.0 * Vec3(random.normal(), random.normal(), random.normal()));
            double lowest = 1e300;
            for (const Vec3& v : body.mesh.vertices) lowest = std::min(lowest, (q * v).z());
            const Pose X_WS{q, Vec3(0.002, -0.001, -lowest - random.uniform(0.003, 0.008))};
            const test::Submerged wet = test::submerged(body.mesh, X_WS);
            const Wrench w = areaPenalty(plane, kTableTop, body, X_WS, kKappa);
            const double expected = kKappa * wet.volume;
            ASSERT_NEAR(w.force.z(), expected, 0.01 * expected) << shape::kindName(shape) << " pose " << i;
            ASSERT_LT(std::hypot(w.force.x(), w.force.y()), 0.01 * expected);
            const Vec3 torque = (wet.moment / wet.volume - X_WS.p).cross(Vec3(0, 0, expected));
            ASSERT_LT((w.torque - torque).norm(), 0.01 * expected * body.shell->reach());
        }
    }
}

TEST(PenaltyTruth, SphereInSphereMatchesTheIntegral) {
    // Truth: closed form (A in the test's comment): with a = D² + R_A², g(s) = R_B a s²/2 - R_B s⁴/4 - a s³/3 + s⁵/5,
    // F = (κπ/D²) [g(R_B) - g(D - R_A)] along the centre line, with the shell's normals. 20, 30, 48 mm: 1.47093e-7 κ.
    const Part large = part(shape::Sphere{0.06}, {.field = true, .cell = 0.5e-3});
    const Part small = part(shape::Sphere{0.04}, {.shell = true, .spacing = 0.4e-3});
    const double RA = 0.02, RB = 0.03, D = 0.048, a = D * D + RA * RA;
    const auto g = [&](double s) {
        return RB * a * s * s / 2 - RB * std::pow(s, 4) / 4 - a * std::pow(s, 3) / 3 + std::pow(s, 5) / 5;
    };
    const double expected = kKappa * std::numbers::pi / (D * D) * (g(RB) - g(D - RA));
    EXPECT_NEAR(expected / kKappa, 1.47093e-7, 1e-11);
    Random random(7);
    for (int i = 0; i < 20; ++i) {
        const Vec3 direction = Vec3(random.normal(), random.normal(), random.normal()).normalized();
        const Wrench w = areaPenalty(large, Pose{}, small, {Quat::Identity(), D * direction}, kKappa);
        EXPECT_NEAR(w.force.norm(), expected, 0.01 * expected);
        EXPECT_LT(std::acos(std::min(1.0, w.force.normalized().dot(direction))), 0.5 * std::numbers::pi / 180);
    }
}

TEST(PenaltyTruth, MaxNormalisedForceIsStiffnessTimesDepthWhateverTheContactArea) {
    // Truth: closed form. F = K p_max, by definition of the variant.
    const Part plane = table();
    for (const shape::Shape& shape : {shape::Shape(shape::Box{0.02, 0.02, 0.02}), shape::Shape(shape::Sphere{0.02})}) {
        const Part body = part(shape, {.shell = true, .spacing = 0.5e-3});
        contact::QueryWorkspace workspace(body.shell->nodes().size());
        contact::ContactManifold manifold(body.shell->points().size());
        const Pose X_WS{Quat::Identity(), Vec3(0, 0, 0.01 - 0.001)};
        const auto answer = contact::queryContacts(*plane.field, kTableTop, *body.shell, X_WS, {}, workspace, manifold);
        scene::ContactSpec contact;
        contact.stiffness = 2000;
        const Wrench w = tick::penaltyWrench(contact, manifold, X_WS.p);
        EXPECT_NEAR(w.force.norm(), 2000 * -answer.phi, 1e-9);
        EXPECT_NEAR(-answer.phi, 0.001, 0.05e-3);  // the sphere's lowest point lies between samples
        EXPECT_GT(w.force.z(), 0.99 * w.force.norm());
    }
}

}  // namespace
}  // namespace passung
