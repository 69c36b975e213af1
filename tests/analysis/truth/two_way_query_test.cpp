#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/query/part_query.h"
#include "tests/support/mesh_pairs.h"

namespace passung {
namespace {

using truth::Relation;

constexpr double kDepthResolution = 50e-6;
constexpr int kPoses = 600;  // a pair

/// An edge of box B across an edge of box A, bisectors facing, with `gap` between the edges.
Pose edgeAcrossEdge(const Vec3& half_a, const Vec3& half_b, double gap, Random& random) {
    // Edge along y of A at (+x, +z); edge along y of B at (+x, +z), turned to face it and to run across it.
    const Vec3 out = Vec3(1, 0, 1).normalized(), along(0, 1, 0);
    const double angle = random.uniform(0.4, 2.7);
    const Vec3 across = Eigen::AngleAxisd(angle, out) * along;
    Mat3 from, to;
    from << out, along, out.cross(along);
    to << -out, across, (-out).cross(across);
    const Mat3 turn = to * from.transpose();
    const Vec3 edge_a(half_a.x(), random.uniform(-0.6, 0.6) * half_a.y(), half_a.z());
    const Vec3 edge_b(half_b.x(), random.uniform(-0.6, 0.6) * half_b.y(), half_b.z());
    return {Quat(turn), edge_a + gap * out - turn * edge_b};
}

struct Outcome {
    int of[4] = {0, 0, 0, 0};
    std::vector<double> one_way_bounds, bounds;
    int operator[](Relation r) const { return of[static_cast<int>(r)]; }
};

/// Compares one pose; truth and result are intervals.
void compare(const test::MeshPair& pair, const Pose& X_FS, query::PartQuery& one_way, query::PartQuery& two_way,
             Outcome& outcome) {
    const auto r = two_way.at(X_FS);
    const test::PairTruth truth = test::truthOf(pair, X_FS, kDepthResolution);
    const double low = std::min(truth.shell_in_field.low, truth.field_in_shell.low);
    const double high = std::min(truth.shell_in_field.high, truth.field_in_shell.high);
    const auto place = [&] {
        ::testing::Message m;
        m << pair.name << ": " << test::toText(X_FS) << "\n  two-way " << r.signed_distance << " ± " << r.error_bound
          << ", in [" << r.lower_bound << ", " << r.upper_bound << "]; truth in [" << low << ", " << high << "], "
          << truth::toString(truth.relation);
        return m;
    };
    EXPECT_LE(std::abs(r.signed_distance - high), r.error_bound + (high - low)) << place();
    EXPECT_LE(r.lower_bound, high) << place();
    EXPECT_GE(r.upper_bound, low) << place();
    if (r.lower_bound > 0.0) {
        EXPECT_EQ(truth.relation, Relation::Apart) << place();
    }
    if (r.upper_bound < 0.0) {
        EXPECT_NE(truth.relation, Relation::Apart) << place();
    }
    ++outcome.of[static_cast<int>(truth.relation)];
    outcome.bounds.push_back(r.error_bound);
    outcome.one_way_bounds.push_back(one_way.at(X_FS).error_bound);
}

double medianOf(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

template <class PoseOf>
Outcome compareAll(test::MeshPair& pair, const PoseOf& poseOf) {
    query::PartQuery one_way(pair.field, pair.shell, {});
    query::PartQueryRequest request;
    request.two_way = true;
    query::PartQuery two_way(pair.field, pair.shell, request);
    Outcome outcome;
    for (int i = 0; i < kPoses && !::testing::Test::HasFailure(); ++i) {
        compare(pair, poseOf(i), one_way, two_way, outcome);
    }
    std::printf(
        "%-26s apart %d, surfaces intersect %d, B inside A %d, A inside B %d; bound median %.2f mm (one way %.2f mm)\n",
        pair.name.c_str(), outcome[Relation::Apart], outcome[Relation::SurfacesIntersect], outcome[Relation::BInsideA],
        outcome[Relation::AInsideB], medianOf(outcome.bounds) * 1e3, medianOf(outcome.one_way_bounds) * 1e3);
    return outcome;
}

// Truth of all: FCL's distance where the surfaces are apart; where they meet or one part holds the other, the depth of
// each surface in the other solid by branch and bound over all of it. Both shells differ in density by four, so that a
// bound of one direction would not serve for the other.

TEST(TwoWayQuery, ErrorBoundHoldsForBallsOfUnequalDensityWithTheSmallOneInside) {
    // Truth: independent program (FCL 0.7) and dense geometry, see above
    test::MeshPair pair("big ball, small ball", test::meshPart(test::bumpyBall(0.02), "two_big", 0.3e-3, 1.6e-3),
                        test::meshPart(test::bumpyBall(0.007), "two_small", 0.2e-3, 0.4e-3));
    Random random(1);
    const Outcome outcome = compareAll(pair, [&](int i) {
        return i % 2 == 0 ? test::poseNearContact(pair, 1e-3, random) : test::poseAnywhere(pair, random);
    });
    EXPECT_GT(outcome[Relation::BInsideA], kPoses / 20);
    EXPECT_GT(outcome[Relation::SurfacesIntersect], kPoses / 5);
    EXPECT_GT(outcome[Relation::Apart], kPoses / 5);
}

TEST(TwoWayQuery, ErrorBoundHoldsWhereTheShellHoldsTheField) {
    // Truth: independent program (FCL 0.7) and dense geometry, see above
    test::MeshPair pair(
        "small cylinder, big box",
        test::meshPart(shape::tessellate(shape::Cylinder{0.004, 0.006}, 5e-6), "two_in", 0.2e-3, 1.6e-3),
        test::meshPart(shape::tessellate(shape::Box{0.02, 0.015, 0.012}, 5e-6), "two_out", 0.3e-3, 0.4e-3));
    Random random(2);
    const Outcome outcome = compareAll(pair, [&](int i) {
        return i % 2 == 0 ? test::poseNearContact(pair, 1e-3, random) : test::poseAnywhere(pair, random);
    });
    EXPECT_GT(outcome[Relation::AInsideB], kPoses / 20);
    EXPECT_GT(outcome[Relation::SurfacesIntersect], kPoses / 5);
}

TEST(TwoWayQuery, ErrorBoundHoldsForEdgesAcrossEdges) {
    // Truth: independent program (FCL 0.7) and dense geometry, see above; a gap is the closed form
    const Vec3 half_a(0.006, 0.008, 0.005), half_b(0.004, 0.009, 0.006);
    const auto box = [](const Vec3& half) {
        return shape::tessellate(shape::Box{2 * half.x(), 2 * half.y(), 2 * half.z()}, 5e-6);
    };
    test::MeshPair pair("boxes, edge across edge", test::meshPart(box(half_a), "two_edge_a", 0.2e-3, 0.4e-3),
                        test::meshPart(box(half_b), "two_edge_b", 0.3e-3, 1.6e-3));
    Random random(3);
    const Outcome outcome = compareAll(pair, [&](int) {
        const double gap = random.uniform(-1e-3, 1e-3);
        const Pose X_FS = edgeAcrossEdge(half_a, half_b, gap, random);
        if (gap > 0.0) {
            EXPECT_NEAR(*pair.oracle.separation(X_FS), gap, 1e-9) << test::toText(X_FS);
        }
        return X_FS;
    });
    EXPECT_GT(outcome[Relation::SurfacesIntersect], kPoses / 3);
    EXPECT_GT(outcome[Relation::Apart], kPoses / 3);
}

TEST(TwoWayQuery, TheFinerShellSharpensTheBoundOnceThePartsAreProvenApart) {
    // Truth: closed form of two balls 0.7 mm apart. The coarse shell alone cannot tell whether they touch; what the
    // fine one proves is more than the coarse one doubts, so that the finer interval holds for both.
    const auto ball = [](double diameter, double spacing) {
        scene::PartSpec spec;
        spec.geometry = shape::Shape{shape::Sphere{diameter}};
        return std::move(*scene::buildPart(spec, {.field = true, .shell = true, .cell = 0.3e-3, .spacing = spacing}));
    };
    const scene::Part fine = ball(0.02, 0.3e-3), coarse = ball(0.02, 0.85e-3);
    query::PartQueryRequest request;
    request.tolerance = std::numeric_limits<double>::infinity();  // the points alone
    const Pose X_FS{Quat::Identity(), 0.0207 * Vec3(3, 4, 12) / 13.0};
    const auto fine_points = query::PartQuery(coarse, fine, request).at(X_FS.inverse());
    const auto coarse_points = query::PartQuery(fine, coarse, request).at(X_FS);
    request.two_way = true;
    const auto both = query::PartQuery(fine, coarse, request).at(X_FS);
    EXPECT_GT(fine_points.lower_bound, 0.0);
    EXPECT_LT(coarse_points.lower_bound, 0.0);
    EXPECT_EQ(both.lower_bound, fine_points.lower_bound);
    EXPECT_LE(both.upper_bound, fine_points.upper_bound);
    EXPECT_LE(both.lower_bound, 0.0007);
    EXPECT_GE(both.upper_bound, 0.0007);
    EXPECT_LE(std::abs(both.signed_distance - 0.0007), both.error_bound);
}

}  // namespace
}  // namespace passung
