#include "tests/bench/row.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/bench/contact_rows.h"
#include "tests/bench/force_rows.h"
#include "tests/bench/marks.h"

namespace passung::bench {
namespace {

TEST(BenchRow, SummaryIsMeanMedianNearestRankAndMaximum) {
    // Truth: closed form. Of 1 … 200: mean 100.5, median 100.5, p99 = the 198th, max 200.
    std::vector<double> values;
    for (int i = 200; i >= 1; --i) values.push_back(i);
    const Times t = summarise(values);
    EXPECT_EQ(t.mean, 100.5);
    EXPECT_EQ(t.median, 100.5);
    EXPECT_EQ(t.p99, 198.0);
    EXPECT_EQ(t.p999, 200.0);
    EXPECT_EQ(t.max, 200.0);
    EXPECT_EQ(summarise({3.0}).p99, 3.0);
}

TEST(BenchRow, CsvLineHasAsManyCellsAsItsHeader) {
    // Truth: invariant. What is missing is NA, never an empty cell.
    const Row row{.group = "g", .method = "m", .settings = "s"};
    const std::string header = csvHeader(), line = csvLine(row);
    EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
    EXPECT_EQ(line.find(",,"), std::string::npos);
}

TEST(BenchRow, CsvLineQuotesItsTexts) {
    // Truth: closed form. As RFC 4180 has it: commas within quotes part nothing, a quote within is doubled.
    const Row row{.group = "a, b", .method = "c, \"d\"", .settings = "e, f"};
    EXPECT_EQ(csvLine(row).find("\"a, b\",\"c, \"\"d\"\"\",\"e, f\",0,NA,"), 0u) << csvLine(row);
}

/// Ours at `time` with a depth error, and FCL at 100 µs.
std::vector<Row> rows(double time, double depth_error_um) {
    Row ours{.group = kPressedGroup, .method = "passung tick", .settings = "s", .ours = true};
    ours.time_us = {time, time, time, time};
    ours.distance_error_um = {depth_error_um, depth_error_um, depth_error_um, depth_error_um};
    ours.force_error_percent = ours.force_turn_deg = ours.torque_error_percent = {0.1, 0.1, 0.1, 0.1};
    Row fcl{.group = kPressedGroup, .method = "FCL all contacts", .settings = "s"};
    fcl.time_us = {100.0, 100.0, 100.0, 100.0};
    return {ours, fcl};
}

TEST(BenchMarks, AreMetAtAFiftiethOfTheTime) {
    // Truth: closed form. 2 µs of 100 µs is 1/50.
    EXPECT_TRUE(judge(rows(2.0, 5.0))[0].met());
    EXPECT_FALSE(judge(rows(2.1, 5.0))[0].met());
    EXPECT_NEAR(judge(rows(2.1, 5.0))[0].value, 0.021, 1e-12);
}

TEST(BenchMarks, JudgeForcesByTheirWorstScene) {
    // Truth: closed form. Of two scenes the worse one counts; of overlaps each has a mark of its own.
    const auto judged = [](double time, double overlap) {
        std::vector<Row> rows;
        for (const double share : {0.5, 1.0}) {
            Row tick{.group = kForceGroup, .method = kTickMethod, .settings = std::to_string(share), .ours = true};
            tick.time_us.p999 = share * time;
            Row part{.group = kForceGroup, .method = kOverlapMethod, .settings = tick.settings, .ours = true};
            part.figure = share * overlap;
            part.figure_mark = 0.01;
            rows.insert(rows.end(), {tick, part});
        }
        return judge(rows);
    };
    const auto whole = [&](double time) {
        for (const Mark& each : judged(time, 0.0))
            if (each.name == "forces: whole tick, p99.9") return each.met();
        return false;
    };
    const auto overlaps = [&](double overlap) {
        int met = 0;
        for (const Mark& each : judged(1.0, overlap))
            met += each.met() && each.name == std::string(kForceGroup) + ": " + kOverlapMethod ? 1 : 0;
        return met;
    };
    EXPECT_TRUE(whole(150.0));
    EXPECT_FALSE(whole(151.0));
    EXPECT_EQ(overlaps(0.01), 2);
    EXPECT_EQ(overlaps(0.011), 1);
    EXPECT_EQ(overlaps(0.021), 0);
}

TEST(BenchMarks, DoNotCountASpeedWithoutItsAccuracy) {
    // Truth: invariant. Fast but 21 µm off counts for nothing, and so does what was not measured.
    EXPECT_FALSE(judge(rows(1.0, 21.0))[0].met());
    EXPECT_FALSE(allMet(judge({})));
}

}  // namespace
}  // namespace passung::bench
