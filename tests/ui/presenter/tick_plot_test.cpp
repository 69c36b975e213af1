#include "ui/presenter/tick_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace passung::presenter {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

truth::PathCost cost(double median, double p999, double found, double proven, bool front, double force = kNone) {
    truth::PathCost row;
    row.setting.geometry = scene::Geometry::Surface;
    row.setting.method = scene::ContactMethod::Penalty;
    row.time.median = median;
    row.time.p999 = p999;
    row.overlap = found;
    row.overlap_bound = proven;
    row.on_overlap_front = front;
    row.force.median = row.force.p99 = force;
    return row;
}

/// Three settings, not in the order of their times.
run::TickFront front() {
    run::TickFront front;
    front.measured.rows = {cost(8e-6, 50e-6, 0.0, 1e-6, true, 0.02), cost(2e-6, 10e-6, 90e-6, 100e-6, true),
                           cost(4e-6, 30e-6, 190e-6, 200e-6, false)};
    front.measured.rows[2].setting.method = scene::ContactMethod::GodObject;
    return front;
}

scene::SceneSpec godObjectOnSurfaces() {
    scene::SceneSpec scene;
    scene.parts.resize(2);
    scene.parts[0].held = true;
    scene.contact.method = scene::ContactMethod::GodObject;
    scene.contact.geometry = scene::Geometry::Surface;
    return scene;
}

TEST(TickPlot, DrawsEverySettingThatHasTheErrorFromFastToSlow) {
    // Truth: closed form: the values above in the units of the plot.
    const TickPlot plot = tickPlot(front(), TickError::Overlap, godObjectOnSurfaces());
    ASSERT_EQ(plot.points.size(), 3u);
    const double times[] = {10.0, 30.0, 50.0}, errors[] = {100.0, 200.0, 1.0};
    const std::size_t rows[] = {1, 2, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(plot.points[i].row, rows[i]);
        EXPECT_NEAR(plot.points[i].time, times[i], 1e-9);
        EXPECT_NEAR(plot.points[i].error, errors[i], 1e-9);
        EXPECT_EQ(plot.points[i].in_study, i == 1);
        for (const double share : {plot.time.shareOf(plot.points[i].time), plot.time.shareOf(plot.points[i].time_low),
                                   plot.error.shareOf(plot.points[i].error)}) {
            EXPECT_GT(share, 0.0);
            EXPECT_LT(share, 1.0);
        }
    }
    EXPECT_EQ(plot.error.shareOf(plot.points[2].error_low), 0.0)
        << "nothing at all was found: the bar ends at the axis";
    EXPECT_EQ(tickPlot(front(), TickError::Force, {}).points.size(), 1u) << "two have no force to compare with";
    EXPECT_NEAR(tickPlot(front(), TickError::Force, {}).points[0].error, 2.0, 1e-9) << "percent";
    EXPECT_TRUE(tickPlot({}, TickError::Overlap, {}).points.empty());
}

TEST(TickPlot, AxesAreLogarithmicWithTicksOfOneTwoAndFive) {
    // Truth: closed form: a decade is as long wherever it is; 2 and 5 only where there are few decades.
    const TickPlot plot = tickPlot(front(), TickError::Overlap, {});
    const LogAxis& error = plot.error;
    EXPECT_NEAR(error.shareOf(10.0) - error.shareOf(1.0), error.shareOf(100.0) - error.shareOf(10.0), 1e-12);
    EXPECT_EQ(error.ticks, (std::vector<double>{1.0, 10.0, 100.0}));
    ASSERT_EQ(plot.time.ticks.size(), 5u);
    EXPECT_NEAR(plot.time.ticks[0], 2.0, 1e-12);
    EXPECT_NEAR(plot.time.ticks[4], 50.0, 1e-12);
    EXPECT_NEAR(plot.time.shareOf(plot.time.low), 0.0, 1e-12);
    EXPECT_NEAR(plot.time.shareOf(plot.time.high), 1.0, 1e-12);
}

TEST(TickPlot, KeysGoAlongTheFrontOnly) {
    // Truth: closed form: of the three points the first and the last are on it.
    const TickPlot plot = tickPlot(front(), TickError::Overlap, {});
    EXPECT_EQ(nextOnFront(plot, std::nullopt, 1), 0u);
    EXPECT_EQ(nextOnFront(plot, 0, 1), 2u);
    EXPECT_EQ(nextOnFront(plot, 1, 1), 2u);
    EXPECT_EQ(nextOnFront(plot, 2, 1), std::nullopt);
    EXPECT_EQ(nextOnFront(plot, std::nullopt, -1), 2u);
    EXPECT_EQ(nextOnFront(plot, 2, -1), 0u);
    EXPECT_EQ(nextOnFront(plot, 0, -1), std::nullopt);
    EXPECT_EQ(nextOnFront({}, std::nullopt, 1), std::nullopt);
}

}  // namespace
}  // namespace passung::presenter
