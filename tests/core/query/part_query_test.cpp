#include "core/query/part_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/field/distance_field.h"

namespace passung {
namespace {

constexpr double kCell = 0.7e-3;

scene::Part build(const shape::Shape& shape, double spacing = 1e-3) {
    scene::PartSpec spec;
    spec.geometry = shape;
    auto part = scene::buildPart(spec, {.field = true, .shell = true, .cell = kCell, .spacing = spacing});
    EXPECT_TRUE(part);
    return std::move(*part);
}

Pose somewhere(double reach, Random& random) {
    return {rotationFromVector(Vec3(random.normal(), random.normal(), random.normal())),
            Vec3(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach))};
}

/// How far above the ball's lowest point its lowest sample lies at most: within the cover radius c a ball of radius R
/// rises by c²/2R, and its mesh lies a chord error higher.
double sampledHeight(const scene::Part& ball, double radius) {
    const double c = ball.shell->coverRadius();
    return c * c / (2.0 * radius) + ball.chord_error;
}

TEST(PartQuery, ABudgetIsKeptUnlessAQualityIsAskedFor) {
    // Truth: closed form (a ball 3 mm deep in a table); the interval holds at any budget; what is proven from
    // below can only fall with it (the same nodes are opened in the same order).
    const scene::Part table = build(shape::Box{0.06, 0.06, 0.02});
    const scene::Part ball = build(shape::Sphere{0.03}, 0.5e-3);
    query::PartQueryRequest request;
    const double depth = 0.003;
    const Pose X_FS{Quat::Identity(), Vec3(0, 0, 0.01 + 0.015 - depth)};
    const auto full = query::PartQuery(table, ball, request).at(X_FS);
    EXPECT_EQ(full.quality, 1.0);
    double last_lower = full.lower_bound;
    for (const int budget : {60, 30, 15}) {
        request.max_nodes = budget;
        const auto part = query::PartQuery(table, ball, request).at(X_FS);
        EXPECT_TRUE(part.budget_reached);
        EXPECT_LE(part.nodes_visited, budget);
        EXPECT_LT(part.quality, 1.0);
        EXPECT_GT(part.error_bound, full.error_bound);
        EXPECT_LE(part.lower_bound, last_lower);
        EXPECT_LE(part.lower_bound, -depth);
        EXPECT_GE(part.upper_bound, -depth);
        EXPECT_LE(std::abs(part.signed_distance + depth), part.error_bound);
        last_lower = part.lower_bound;
    }
    request.quality = 1.0;
    const auto floor = query::PartQuery(table, ball, request).at(X_FS);
    EXPECT_TRUE(floor.quality_overruled_budget);
    EXPECT_EQ(floor.signed_distance, full.signed_distance);
    EXPECT_EQ(floor.error_bound, full.error_bound);
}

TEST(PartQuery, TwoWaysOfASphereInAPlaneAgreeOnDepthAndWrench) {
    // Truth: closed form. From the ball's points F = κ × volume of the cap; from the table's points
    // κ ∫ (R - distance from the centre) dA over the disc that the face cuts out; two-way is their mean.
    // Depth: the field of a plane is exact (up to its floats), that of a ball never below φ, which is convex; the
    // lowest point lies within sampledHeight of a sample. Force: sums over a disc of 9 mm radius sampled every 0.7 mm,
    // 1 %.
    const scene::Part table = build(shape::Box{0.08, 0.08, 0.04}, 0.7e-3);
    const scene::Part ball = build(shape::Sphere{0.04}, 0.7e-3);
    query::PartQueryRequest request;
    request.two_way = true;
    const double h = 0.002, R = 0.02, off = R - h;
    const auto r = query::PartQuery(table, ball, request).at({Quat::Identity(), Vec3(0, 0, 0.02 + R - h)});
    EXPECT_GE(r.signed_distance, -h - 1e-8);
    EXPECT_LE(r.signed_distance, -h + sampledHeight(ball, R));
    const auto cube = [](double x) { return x * x * x; };
    const double cap = std::numbers::pi * h * h * (3 * R - h) / 3;
    const double disc = std::numbers::pi * (R * (R * R - off * off) - 2.0 / 3.0 * (cube(R) - cube(off)));
    const double expected = 1e9 * 0.5 * (cap + disc);
    EXPECT_NEAR(r.wrench.force.z(), expected, 0.01 * expected);
    EXPECT_LT(r.wrench.force.head<2>().norm(), 0.01 * expected);
    EXPECT_LT(r.wrench.torque.norm(), 0.01 * expected * R);
}

TEST(PartQuery, OfAShapeTheFieldsErrorWhereItWasReadIsKnownExactly) {
    // Truth: closed form of the plate. A peg leans towards a bore that is 0.1 mm wider; at rims and over the blind
    // floor the field's own bound, the largest of 64 cells, is many times what it errs by. What is above the distance
    // read are that error, and the chords.
    const auto built = [](const shape::Shape& shape) {
        scene::PartSpec spec;
        spec.geometry = shape;
        auto part = scene::buildPart(spec, {.field = true, .shell = true});
        EXPECT_TRUE(part);
        return std::move(*part);
    };
    const shape::Shape bore = shape::BorePlate{0.03, 0.03, 0.025, 0.01, 0.02, 0.5e-3};
    const scene::Part plate = built(bore), peg = built(shape::Peg{0.0099, 0.03, 0.5e-3});
    query::PartQueryRequest unrefined;
    unrefined.tolerance = std::numeric_limits<double>::infinity();
    query::PartQuery query(plate, peg, unrefined);
    const double chords = plate.chord_error + peg.chord_error + peg.shell->rounding();
    double largest_bound = 0.0;
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        const double lean = 40e-6 * random.uniform();
        const auto r = query.at({Quat::Identity(), Vec3(lean, 0.5 * lean, -0.02 * random.uniform())});
        const double error = std::abs(r.signed_distance - shape::signedDistance(bore, r.closest));
        ASSERT_NEAR(r.upper_bound, r.signed_distance + error + chords, 1e-11);
        ASSERT_GE(r.field_error_bound, error);
        largest_bound =
            std::max(largest_bound, plate.field->errorBound(r.closest, field::FieldMode::Trilinear) - error);
    }
    EXPECT_GT(largest_bound, 20e-6);
}

TEST(PartQuery, TheBoundHoldsAndIsNoLargerThanSpacingAndCellAllow) {
    // Truth: closed form of two spheres. Within the fine bricks (four cells of the surface) the field errs by less than
    // √3 cells (each corner is nearer than a diagonal), which enters twice: at the closest point and below it.
    const scene::Part a = build(shape::Sphere{0.03}), b = build(shape::Sphere{0.02});
    const double chords = a.chord_error + b.chord_error;
    const double most = std::sqrt(3.0) * kCell + b.shell->coverRadius() + chords;
    Random random(3);
    query::PartQueryRequest unrefined;
    unrefined.tolerance = std::numeric_limits<double>::infinity();
    query::PartQuery query(a, b, unrefined), refined(a, b, {});
    int near = 0;
    for (const double reach : {0.02, 0.05, 0.5, 5.0}) {
        for (int i = 0; i < 400; ++i) {
            const Pose X_FS = somewhere(reach, random);
            // The point of b's surface that lies nearest to a's centre.
            const double truth = std::abs(X_FS.p.norm() - 0.01) - 0.015;
            const auto r = query.at(X_FS);
            ASSERT_LE(std::abs(r.signed_distance - truth), r.error_bound);
            ASSERT_LE(r.lower_bound, truth);
            ASSERT_GE(r.upper_bound, truth);
            ASSERT_LE(r.field_error_bound, r.error_bound);
            ASSERT_LE(std::abs(r.signed_distance - (r.closest.norm() - 0.015)), r.field_error_bound);
            ASSERT_FALSE(r.beyond_proximity);
            if (std::abs(truth) <= 2.0 * kCell) {
                ASSERT_LE(r.error_bound, most);
                ++near;
            }
            if (i % 32 != 0) continue;  // some take a tenth of a second
            const auto exact = refined.at(X_FS);
            ASSERT_LE(std::abs(exact.signed_distance - truth), exact.error_bound);
            ASSERT_LE(exact.lower_bound, truth);
            ASSERT_GE(exact.upper_bound, truth);
            ASSERT_LE(std::abs(exact.signed_distance - (exact.closest.norm() - 0.015)), chords);
            // What remains are the chords, and the tolerance where depth is sought; deep inside and far away, where
            // much of the ball is about equally near, steps may run out.
            if (truth > -1.5e-3 && truth < 0.1) {
                ASSERT_LE(exact.error_bound, 20e-6 + 2.0 * chords) << truth;
            }
        }
    }
    EXPECT_GT(near, 30);
}

TEST(PartQuery, TheBoundHoldsUnderEveryBudget) {
    // Truth: closed form of two spheres, at poses where they overlap, touch and are apart. A budget leaves more to be
    // proven, never something wrong; the mean bound falls with the budget.
    const scene::Part a = build(shape::Sphere{0.03}), b = build(shape::Sphere{0.02}, 0.5e-3);
    double last_mean = 1e300;
    for (const int budget : {8, 20, 50, 150, 500, 2000}) {
        query::PartQueryRequest request;
        request.max_nodes = budget;
        query::PartQuery query(a, b, request);
        Random random(5);
        double mean = 0.0;
        for (int i = 0; i < 150; ++i) {
            Pose X_FS = somewhere(0.0, random);
            const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
            X_FS.p = (0.025 + random.uniform(-3e-3, 3e-3)) * way;
            const double truth = X_FS.p.norm() - 0.025;
            const auto r = query.at(X_FS);
            ASSERT_LE(r.nodes_visited, budget);
            ASSERT_LE(r.lower_bound, truth) << budget;
            ASSERT_GE(r.upper_bound, truth) << budget;
            ASSERT_LE(std::abs(r.signed_distance - truth), r.error_bound) << budget;
            mean += r.error_bound / 150.0;
        }
        EXPECT_LT(mean, last_mean) << budget;
        last_mean = mean;
    }
    EXPECT_LT(last_mean, 100e-6);
}

TEST(PartQuery, BeyondTheProximityTheTruthIsNotBelowWhatIsSaid) {
    // Truth: closed form of two spheres. 10 mm is below all true distances; two-way, one found direction is enough.
    const scene::Part a = build(shape::Sphere{0.03}), b = build(shape::Sphere{0.02});
    for (const bool two_way : {false, true}) {
        query::PartQueryRequest request;
        request.proximity = 0.01;
        request.two_way = two_way;
        for (const double distance : {0.0102, 0.011, 0.02, 0.175}) {
            const auto r = query::PartQuery(a, b, request).at({Quat::Identity(), Vec3(0.025 + distance, 0, 0)});
            EXPECT_TRUE(r.beyond_proximity);
            EXPECT_EQ(r.signed_distance, 0.01);
            EXPECT_LE(r.signed_distance - r.error_bound, distance);
            EXPECT_LE(r.lower_bound, distance);
            EXPECT_GE(r.upper_bound, distance);
            EXPECT_TRUE(std::isfinite(r.error_bound));
        }
        const auto near = query::PartQuery(a, b, request).at({Quat::Identity(), Vec3(0.030, 0, 0)});
        EXPECT_FALSE(near.beyond_proximity);
        EXPECT_LE(std::abs(near.signed_distance - 0.005), near.error_bound);
    }
}

TEST(PartQuery, TheBoundOfASheetHoldsItsOffset) {
    // Truth: closed form. A ball above an open sheet: the distance from the sheet itself, which the field takes its
    // offset from.
    const scene::Part sheet = build(shape::Sheet{0.05, 0.05}), ball = build(shape::Sphere{0.02}, 0.4e-3);
    ASSERT_GT(sheet.field->sheetOffset(), 0.0);
    query::PartQuery query(sheet, ball, {});
    for (double gap = 0.0; gap < 0.004; gap += 0.1e-3) {
        for (const double side : {1.0, -1.0}) {
            const auto r = query.at({Quat::Identity(), Vec3(0.004, -0.003, side * (0.01 + gap))});
            EXPECT_LE(std::abs(r.signed_distance - gap), r.error_bound) << gap;
            EXPECT_LE(r.lower_bound, gap);
            EXPECT_GE(r.upper_bound, gap);
        }
    }
}

}  // namespace
}  // namespace passung
