#include "analysis/truth/accuracy_ticks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/truth/accuracy_tick_tables.h"
#include "tests/support/scenes.h"

namespace passung::truth {
namespace {

using scene::ContactMethod;
using scene::Geometry;

constexpr double kRadius = 0.01, kTop = 0.02, kDepth = 1e-3;  // of ball, box and the deepest press [m]
constexpr double kStiffness = 1000.0;                         // [N/m]

/// A ball that is pressed into a box's top face by kDepth, sine from and to 1 mm above it, slid aside meanwhile.
class PressedBall : public ::testing::Test {
protected:
    static scene::SceneSpec scene() {
        auto spec = test::scene(shape::Sphere{2 * kRadius}, Pose{Quat::Identity(), Vec3(0, 0, kRadius + kTop + 1e-3)},
                                shape::Box{0.06, 0.06, 2 * kTop}, Pose{}, ContactMethod::GodObject);
        spec.contact.stiffness = kStiffness;
        spec.contact.damping = 5.0;  // the scene's business: no part of the spring
        spec.contact.cell = 0.0;
        spec.contact.tolerance = 20e-6;
        spec.contact.spacing = 1e-3;
        spec.limits.max_force = 0.5;  // likewise
        return spec;
    }
    static double depthAt(int tick) { return -1e-3 + (1e-3 + kDepth) * std::sin(M_PI * tick / 200.0); }
    static std::vector<Pose> path() {
        std::vector<Pose> path;
        for (int i = 0; i <= 200; ++i)
            path.push_back({Quat::Identity(), Vec3(1e-5 * i, 0.0, kRadius + kTop - depthAt(i))});
        return path;
    }
    static TickAccuracy measure(const scene::SceneSpec& spec, const TickSpace& space) {
        auto result = measureTicks(spec, path(), tickSettings(spec, space).settings, {.repetitions = 2, .every = 10},
                                   [](const std::string&, double) {});
        EXPECT_TRUE(result);
        return *std::move(result);
    }
    static const PathCost& rowOf(const TickAccuracy& result, ContactMethod method, Geometry geometry) {
        const auto row = std::find_if(result.rows.begin(), result.rows.end(), [&](const PathCost& r) {
            return r.setting.method == method && r.setting.geometry == geometry;
        });
        EXPECT_NE(row, result.rows.end());
        return *row;
    }
};

TEST_F(PressedBall, OverlapAndForceAreThoseOfASphereAndAPlane) {
    // Truth: closed form. The ball's deepest point is `depth` below the plane: that is the penalty's overlap; the
    // spring's force is K depth along the normal; a god object on closed forms shows no overlap and has that force.
    // Triangles of the ball and bound of the search: 0.5 µm each. Points 1 mm apart: at most c²/2r from the deepest
    // point, c the cover radius, of about a spacing; besides, the field's tolerance.
    const auto result =
        measure(scene(), {.methods = {ContactMethod::Penalty, ContactMethod::GodObject}, .spacings = {1e-3}});
    EXPECT_TRUE(result.notes.empty());
    const PathCost& penalty = rowOf(result, ContactMethod::Penalty, Geometry::Field);
    EXPECT_NEAR(penalty.overlap, kDepth, 0.01 * kDepth + 1e-6);
    EXPECT_GE(penalty.overlap_bound, kDepth - 5e-7);
    EXPECT_LE(penalty.overlap_bound, 1.011 * kDepth + 1e-6);
    EXPECT_LE(penalty.force_error, kStiffness * (1e-3 * 1e-3 / (2 * kRadius) + 40e-6));
    EXPECT_LE(penalty.direction.max, 0.05);
    const PathCost& closed = rowOf(result, ContactMethod::GodObject, Geometry::ClosedForm);
    EXPECT_LE(closed.overlap, 3e-7);
    EXPECT_LE(closed.overlap_bound, 1e-6);
    EXPECT_LE(closed.force_error, kStiffness * 3e-7);
    EXPECT_LE(closed.direction.max, 1e-4);
    EXPECT_EQ(closed.suspended, 0u);
    for (const PathCost& row : result.rows) {
        EXPECT_EQ(row.ticks, 201u);
        EXPECT_GE(row.judged, 21u);
        EXPECT_EQ(row.referenced, row.judged);
        EXPECT_GT(row.bytes, 0.0);
        EXPECT_LE(row.time.median, row.time.p999);
        EXPECT_LE(row.time.p999, row.time.max);
    }
    // The force of a spring to a plane changes as the hand goes, by no more: closed forms have no grain.
    EXPECT_LE(closed.grain.max, kStiffness * 1e-9);
}

TEST_F(PressedBall, WhatLiesBetweenPointsIsJudgedByWhatIsShown) {
    // Truth: closed form. Points 8 mm apart on a ball of 10 mm: the deepest is up to c²/2r = 3 mm above the ball's
    // lowest point, so that the recorded overlap says less than the true one, which is the depth of the press.
    auto spec = scene();
    const auto result = measure(spec, {.methods = {ContactMethod::Penalty}, .tolerances = {50e-6}, .spacings = {8e-3}});
    ASSERT_EQ(result.rows.size(), 1u);
    EXPECT_NEAR(result.rows[0].overlap, kDepth, 0.01 * kDepth + 1e-6);
}

TEST_F(PressedBall, IsTheSameAgainButForTimes) {
    // Truth: invariant
    const TickSpace space{.tolerances = {50e-6}, .spacings = {2e-3}};
    auto a = measure(scene(), space), b = measure(scene(), space);
    ASSERT_EQ(a.rows.size(), b.rows.size());
    for (auto* result : {&a, &b})
        for (PathCost& row : result->rows) {
            row.time = row.wall = {};
            row.on_overlap_front = row.on_force_front = false;
        }
    EXPECT_EQ(tickCsv(a), tickCsv(b));
}

TEST_F(PressedBall, SettingsAreThoseThatThePairCanHave) {
    // Truth: contact_geometry.h: the penalty is a sum over points; a sheet has no closed form; what rubs has fields
    // alone.
    const TickSettings all = tickSettings(scene(), {});
    const auto count = [](const TickSettings& settings, Geometry geometry) {
        return std::count_if(settings.settings.begin(), settings.settings.end(),
                             [&](const TickSetting& s) { return s.geometry == geometry; });
    };
    EXPECT_EQ(count(all, Geometry::ClosedForm), 2);
    EXPECT_EQ(count(all, Geometry::Surface), 2);
    EXPECT_EQ(count(all, Geometry::Field), 3 * 2 * 2);
    EXPECT_EQ(all.left_out.size(), 2u);
    auto sheet = scene();
    sheet.parts[1].geometry = shape::Sheet{0.05, 0.05};
    EXPECT_EQ(count(tickSettings(sheet, {}), Geometry::ClosedForm), 0);
    auto rubbing = scene();
    for (auto& part : rubbing.parts) part.friction = 0.2;
    EXPECT_EQ(count(tickSettings(rubbing, {}), Geometry::ClosedForm), 0);
    EXPECT_EQ(count(tickSettings(rubbing, {}), Geometry::Surface), 2);
    const auto two = tickSettings(scene(), {.methods = {ContactMethod::GodObject},
                                            .geometries = {Geometry::Field},
                                            .tolerances = {50e-6},
                                            .spacings = {1e-3},
                                            .budgets = {0, 100},
                                            .ways = {1, 2}});
    EXPECT_EQ(two.settings.size(), 4u);
}

TEST_F(PressedBall, AForceWithoutReferenceIsNotMadeUp) {
    // Truth: invariant: an area-weighted penalty is no stiffness times a depth.
    auto spec = scene();
    spec.contact.variant = scene::PenaltyVariant::AreaWeighted;
    const auto result = measure(spec, {.methods = {ContactMethod::Penalty}, .tolerances = {50e-6}, .spacings = {2e-3}});
    ASSERT_EQ(result.rows.size(), 1u);
    EXPECT_EQ(result.rows[0].referenced, 0u);
    EXPECT_TRUE(std::isnan(result.rows[0].force_error));
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_NE(result.notes[0].find("variant"), std::string::npos);
}

TEST(TickFront, HoldsExactlyTheRowsThatNoOtherBeats) {
    // Truth: closed form. By hand, (time, overlap): (3, 6) is beaten by (2, 5), (4, 2) by (4, 1); two that are alike
    // are both on the front.
    std::vector<PathCost> rows(6);
    const double time[] = {3, 1, 4, 2, 4, 2}, overlap[] = {6, 9, 2, 5, 1, 5};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].time.p999 = time[i];
        rows[i].overlap_bound = overlap[i];
    }
    markTickFronts(rows);
    const bool expected[] = {false, true, false, true, true, true};
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].on_overlap_front, expected[i]) << i;
    for (const PathCost& row : rows) EXPECT_FALSE(row.on_force_front) << "none has a force";
}

TEST(TickSpread, IsByNearestRank) {
    // Truth: closed form: of 1 … 2000 the 99.9th percentile is the 1998th, the median the 1000th.
    std::vector<double> values;
    for (int i = 2000; i > 0; --i) values.push_back(i);
    const TickSpread spread = tickSpreadOf(values);
    EXPECT_EQ(spread.median, 1000.0);
    EXPECT_EQ(spread.p999, 1998.0);
    EXPECT_EQ(spread.max, 2000.0);
    EXPECT_TRUE(std::isnan(tickSpreadOf({}).max));
}

}  // namespace
}  // namespace passung::truth
