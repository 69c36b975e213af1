#include "core/contact/edge_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/field/distance_field.h"
#include "core/scene/part.h"
#include "core/tick/proxy.h"
#include "tests/support/scenes.h"

namespace passung::contact {
namespace {

constexpr double kHalf = 5e-3, kTolerance = 10e-6, kSpacing = 1e-3;

scene::Part partOf(const shape::Shape& shape, bool field) {
    auto part = scene::buildPart({.name = "part", .geometry = shape, .X_WP = {}},
                                 {.field = field, .shell = true, .tolerance = kTolerance, .spacing = kSpacing});
    if (!part) ADD_FAILURE() << toString(part.errors().front());
    return std::move(*part);
}

const scene::Part& roof() {  // a block on its edge: that along y at the top is a right angle
    static const scene::Part part = partOf(shape::Box{2 * kHalf, 4 * kHalf, 2 * kHalf}, true);
    return part;
}
const scene::Part& beam() {
    static const scene::Part part = partOf(shape::Box{4 * kHalf, 2 * kHalf, 2 * kHalf}, false);
    return part;
}

Quat turn(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis)); }

const Pose kRoof{turn(Vec3::UnitY(), std::numbers::pi / 4), Vec3(0, 0, -std::numbers::sqrt2* kHalf)};

/// The lower edge of the beam across the ridge, `depth` below it, moved along both and turned about the vertical.
Pose across(double depth, double along_ridge, double along_beam, double yaw) {
    const Quat q = turn(Vec3::UnitZ(), yaw) * turn(Vec3::UnitX(), std::numbers::pi / 4);
    return {q, q * Vec3(along_beam, 0, 0) + Vec3(0, along_ridge, std::numbers::sqrt2 * kHalf - depth)};
}

double deepest(const ContactManifold& manifold) {
    double least = 1.0;
    for (const ContactPoint& contact : manifold) least = std::min(least, contact.phi);
    return least;
}

TEST(EdgeSearch, FindsTwoEdgesThatCrossBetweenTheirSamples) {
    // Truth: closed form. The beam's edge runs level `depth` below a ridge of 90°, across it: φ along it is
    // max over the two faces of (x - depth)/√2 and (-x - depth)/√2, least over the ridge with -depth/√2, where the
    // normal to both edges is vertical; φ grows by cos 45° of what the beam is lifted by. Of depths far below the
    // distance of the samples the shell itself sees next to none.
    Random random(7);
    ContactManifold manifold(1000);
    for (int i = 0; i < 200; ++i) {
        const double depth = random.uniform(20e-6, 150e-6);
        const Pose X = across(depth, random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 0.0);
        manifold.clear();
        const QueryAnswer answer = searchEdges(*roof().field, kRoof, *beam().edges, X, {}, manifold);
        ASSERT_TRUE(answer.found);
        // The ridge is blunt by what the field errs by.
        EXPECT_NEAR(answer.phi, -depth / std::numbers::sqrt2, kTolerance);
        ASSERT_GE(manifold.size(), 1u);
        const ContactPoint& contact = manifold[0];
        EXPECT_NEAR(contact.position.x(), 0.0, kTolerance);
        EXPECT_NEAR(contact.gradient.x(), 0.0, 1e-9);
        EXPECT_NEAR(contact.gradient.y(), 0.0, 0.02);
        EXPECT_NEAR(contact.gradient.z(), 1.0 / std::numbers::sqrt2, 0.02);
    }
}

TEST(EdgeSearch, TellsHowTheContactGivesWayToMotion) {
    // Truth: closed form. Two edges at an angle touch along their common normal, whatever the angle: with b the
    // direction of the beam's edge the gradient is square to it. 1e-9: it is mixed to be so.
    ContactManifold manifold(1000);
    for (const double yaw : {-0.6, -0.2, 0.15, 0.7}) {
        const Pose X = across(50e-6, 0.4e-3, 0.7e-3, yaw);
        manifold.clear();
        searchEdges(*roof().field, kRoof, *beam().edges, X, {}, manifold);
        ASSERT_GE(manifold.size(), 1u);
        EXPECT_NEAR(manifold[0].gradient.dot(X.q * Vec3::UnitX()), 0.0, 1e-9);
        EXPECT_NEAR(manifold[0].gradient.y(), 0.0, 0.02);
    }
}

TEST(EdgeSearch, FindsTheLowestPlaceOfARimBetweenItsSamples) {
    // Truth: closed form. A tilted disc over a block's face: its rim is lowest in one place, wherever the samples lie.
    // The chords of the rim are off by a share of the tolerance.
    const scene::Part disc = partOf(shape::Cylinder{10e-3, 4e-3}, false);
    ContactManifold manifold(1000);
    constexpr double kTilt = 0.3, kDepth = 3e-6;
    for (int i = 0; i < 100; ++i) {
        const Quat q = turn(Vec3::UnitX(), kTilt) * turn(Vec3::UnitZ(), 0.01 * i);
        const double low = 5e-3 * std::sin(kTilt) + 2e-3 * std::cos(kTilt);
        manifold.clear();
        const auto answer = searchEdges(*roof().field, Pose{Quat::Identity(), Vec3(0, 0, -kHalf)}, *disc.edges,
                                        {q, Vec3(0, 0, low - kDepth)}, {}, manifold);
        ASSERT_TRUE(answer.found);
        EXPECT_NEAR(answer.phi, -kDepth, 0.5e-6);
    }
}

TEST(EdgeSearch, LeavesCornersToTheSamples) {
    // Truth: closed form. The beam stands on its corner, 50 um deep in the block's face: along none of the three edges
    // that meet there is a place lower than the corner, which is a sample.
    const Quat q = rotationBetween(Vec3(-2, -1, -1), -Vec3::UnitZ());
    const double low = (q * Vec3(-2, -1, -1) * kHalf).norm();
    ContactManifold manifold(1000);
    const QueryRequest near{.collect_below = 20e-6, .search_below = 20e-6};
    const Pose X_WF{Quat::Identity(), Vec3(0, 0, -kHalf)}, X{q, Vec3(0, 0, low - 50e-6)};
    EXPECT_FALSE(searchEdges(*roof().field, X_WF, *beam().edges, X, near, manifold).found);
    EXPECT_EQ(manifold.size(), 0u);
    QueryWorkspace workspace(beam().shell->nodes().size());
    EXPECT_NEAR(queryContacts(*roof().field, X_WF, *beam().shell, X, near, workspace, manifold).phi, -50e-6, 0.1e-6);
}

TEST(EdgeSearch, IsLeftOutUnderABudgetAndWhereTheFieldSaysTooLittle) {
    // Truth: invariant. Values that jump from voxel to voxel have no least place along an edge, cells of one size blunt
    // the other edge; a budget leaves no work but what it counts.
    const scene::Part blunt =
        *scene::buildPart({.name = "roof", .geometry = shape::Box{2 * kHalf, 4 * kHalf, 2 * kHalf}, .X_WP = {}},
                          {.field = true, .cell = 0.5e-3});
    const Pose X = across(50e-6, 0.4e-3, 0.7e-3, 0.15);
    ContactManifold manifold(1000);
    const auto searched = [&](const field::DistanceField& field, const QueryRequest& request) {
        return searchEdges(field, kRoof, *beam().edges, X, request, manifold).points_tested > 0;
    };
    EXPECT_TRUE(searched(*roof().field, {}));
    EXPECT_TRUE(searched(*roof().field, {.mode = field::FieldMode::Cubic}));
    for (const auto mode : {field::FieldMode::Layered, field::FieldMode::SurfacePoint, field::FieldMode::Linear})
        EXPECT_FALSE(searched(*roof().field, {.mode = mode}));
    EXPECT_FALSE(searched(*roof().field, {.max_nodes = 1000}));
    EXPECT_FALSE(searched(*blunt.field, {}));
}

TEST(EdgeSearch, ProxyLeavesEdgesApartThatCrossBetweenTheirSamples) {
    // Truth: closed form. The beam is pushed 2 mm down on the ridge and to and fro along it; the edges part where the
    // beam's edge lies at the ridge's height. The proxy accepts as much overlap as the field may err by, and the field
    // errs; both are distances to a face, at 45° to the depth. The samples of an edge are 0.5 mm apart.
    for (const auto method : {scene::ContactMethod::GodObjectHeuristic, scene::ContactMethod::GodObject}) {
        auto spec = test::scene(shape::Box{4 * kHalf, 2 * kHalf, 2 * kHalf}, across(-1e-3, 0, 0, 0),
                                shape::Box{2 * kHalf, 4 * kHalf, 2 * kHalf}, kRoof, method);
        spec.contact.cell = 0.0;
        spec.contact.tolerance = kTolerance;
        spec.contact.spacing = kSpacing;
        spec.contact.rotational_stiffness = 1000.0;  // so stiff that the beam does not tilt
        spec.contact.two_way = true;
        test::Bench bench(spec);
        double worst = 0.0;
        for (int i = 0; i < 400; ++i) {
            const double down = std::min(3e-3, 2e-5 * i), along = 2e-3 * std::sin(0.03 * i);
            const auto out = bench.step(across(down - 1e-3, along, 0.7 * along, 0.0));
            const Vec3 low = out.X_WG * Vec3(0, -kHalf, -kHalf);
            worst = std::max(worst, -low.z());
        }
        EXPECT_LE(worst, 2.0 * std::numbers::sqrt2 * kTolerance);
        EXPECT_GT(deepest(bench.state().manifold), -2.0 * kTolerance);
    }
}

}  // namespace
}  // namespace passung::contact
