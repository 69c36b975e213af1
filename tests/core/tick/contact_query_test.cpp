#include "core/tick/contact_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/model/part.h"
#include "core/tick/part_query.h"

namespace passung {
namespace {

model::Part build(const model::Shape& shape, double spacing = 1e-3) {
    model::PartSpec spec;
    spec.geometry = shape;
    auto part = model::buildPart(spec, {.field = true, .shell = true, .cell = 0.7e-3, .spacing = spacing});
    EXPECT_TRUE(part);
    return std::move(*part);
}

Pose somewhere(double reach, Random& random) {
    return {rotationFromVector(Vec3(random.normal(), random.normal(), random.normal())),
            Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach))};
}

struct BruteForce {
    double phi = 1e300;
    std::size_t inside = 0;
    Vec3 area_force = Vec3::Zero();
};

/// Every point of the shell through the same field, without the tree.
BruteForce bruteForce(const model::Part& field, const Pose& X_WF, const model::Part& shell, const Pose& X_WS) {
    BruteForce result;
    for (const auto& point : shell.shell->points()) {
        const Vec3 p = X_WF.inverse() * (X_WS * point.position);
        const double phi = field.field->sample(p, model::FieldMode::Trilinear).phi;
        result.phi = std::min(result.phi, phi);
        if (!(phi < 0.0)) continue;
        ++result.inside;
        result.area_force += point.area * phi * (X_WS.q * point.normal);
    }
    return result;
}

TEST(ContactQuery, FindsExactlyWhatTestingEveryPointFinds) {
    // Truth: invariant. The tree prunes only what is proven to be out of reach.
    const model::Part plate = build(model::BorePlate{0.05, 0.05, 0.02, 0.0204, 0.02, 0.001});
    const model::Part peg = build(model::Peg{0.02, 0.04, 0.001});
    tick::QueryWorkspace workspace(peg.shell->nodes().size());
    tick::ContactManifold manifold(peg.shell->points().size());
    Random random(1);
    int touching = 0;
    for (int i = 0; i < 500; ++i) {
        const Pose X_WF = somewhere(0.2, random);
        const Pose X_FS = i % 4 == 0 ? Pose{rotationFromVector(1e-3 * Vec3(random.normal(), random.normal(), 0)),
                                            Vec3(random.uniform(-2e-4, 2e-4), random.uniform(-2e-4, 2e-4), -0.01)}
                                     : somewhere(0.04, random);
        const Pose X_WS = X_WF * X_FS;
        manifold.clear();
        tick::QueryRequest request;
        request.search_below = 1.0;
        const auto answer = tick::queryContacts(*plate.field, X_WF, *peg.shell, X_WS, request, workspace, manifold);
        const BruteForce truth = bruteForce(plate, X_WF, peg, X_WS);
        ASSERT_NEAR(answer.phi, truth.phi, 1e-12);
        ASSERT_EQ(manifold.size(), truth.inside);
        ASSERT_EQ(answer.quality, 1.0);
        touching += truth.inside > 0 ? 1 : 0;
        if (truth.inside > 0) continue;
        ASSERT_LT(answer.points_tested, static_cast<int>(peg.shell->points().size()));
    }
    EXPECT_GT(touching, 100);
    EXPECT_LT(touching, 450);
}

TEST(ContactQuery, StopsAtItsBudgetAndSaysWhatItDidNotProve) {
    // Truth: invariant. Quality falls with the budget; the whole tree gives quality 1; the wrench stays near the full
    // one because unexpanded nodes stand in with their area.
    const model::Part table = build(model::Box{0.06, 0.06, 0.02});
    const model::Part ball = build(model::Sphere{0.03}, 0.5e-3);
    tick::PartQueryRequest request;
    const Pose X_FS{Quat::Identity(), Vec3(0, 0, 0.01 + 0.015 - 0.003)};
    const auto full = tick::PartQuery(table, ball, request).at(X_FS);
    EXPECT_EQ(full.quality, 1.0);
    double last_quality = 1.1;
    for (const int budget : {60, 30, 15}) {
        request.max_nodes = budget;
        const auto part = tick::PartQuery(table, ball, request).at(X_FS);
        EXPECT_TRUE(part.budget_reached);
        EXPECT_LE(part.nodes_visited, budget);
        EXPECT_LE(part.quality, last_quality);
        EXPECT_GT(part.wrench.force.z(), 0.3 * full.wrench.force.z());
        EXPECT_LT(part.wrench.force.z(), 3.0 * full.wrench.force.z());
        last_quality = part.quality;
    }
    EXPECT_LT(last_quality, 1.0);
    request.quality = 1.0;  // a floor wins over the budget, and says so
    const auto floor = tick::PartQuery(table, ball, request).at(X_FS);
    EXPECT_TRUE(floor.quality_overruled_budget);
    EXPECT_EQ(floor.signed_distance, full.signed_distance);
}

TEST(PartQuery, TwoWaysOfASphereInAPlaneAgreeOnDepthAndWrench) {
    // Truth: closed form. h = 2 mm; F = κ π h² (3R - h) / 3 from the sphere's side.
    const model::Part table = build(model::Box{0.08, 0.08, 0.04}, 0.7e-3);
    const model::Part ball = build(model::Sphere{0.04}, 0.7e-3);
    tick::PartQueryRequest request;
    request.two_way = true;
    const double h = 0.002, R = 0.02;
    const auto r = tick::PartQuery(table, ball, request).at({Quat::Identity(), Vec3(0, 0, 0.02 + R - h)});
    EXPECT_NEAR(r.signed_distance, -h, r.error_bound);
    const double expected = 1e9 * 3.14159265358979 * h * h * (3 * R - h) / 3;
    EXPECT_NEAR(r.wrench.force.z(), expected, 0.05 * expected);
    EXPECT_LT(r.wrench.torque.norm(), 0.02 * expected * R);
}

TEST(PartQuery, DistanceIsWithinItsBoundOfTheTruthNearAndFar) {
    // Truth: closed form of two spheres.
    const model::Part a = build(model::Sphere{0.03}), b = build(model::Sphere{0.02});
    Random random(3);
    for (const double reach : {0.02, 0.05, 0.5, 5.0}) {
        for (int i = 0; i < 100; ++i) {
            const Pose X_FS = somewhere(reach, random);
            // The point of b's surface that lies nearest to a's centre.
            const double truth = std::abs(X_FS.p.norm() - 0.01) - 0.015;
            const auto r = tick::PartQuery(a, b, {}).at(X_FS);
            ASSERT_LE(std::abs(r.signed_distance - truth), r.error_bound);
            ASSERT_FALSE(r.beyond_proximity);
        }
    }
    tick::PartQueryRequest request;
    request.proximity = 0.01;
    const auto far = tick::PartQuery(a, b, request).at({Quat::Identity(), Vec3(0.2, 0, 0)});
    EXPECT_TRUE(far.beyond_proximity);
    EXPECT_EQ(far.signed_distance, 0.01);
}

}  // namespace
}  // namespace passung
