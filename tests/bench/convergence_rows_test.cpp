#include "tests/bench/convergence_rows.h"

#include <gtest/gtest.h>

namespace passung::bench {
namespace {

TEST(Convergence, ErrorsFallAsDerived) {
    // Truth: closed form; the orders are derived in convergence_rows.h. A mean over 20 000 points or 400 poses of three
    // resolutions: what is left of the placement of cells and points moves an order by less than 0.25.
    Extent extent;
    extent.wanted = [](const std::string&, const std::string&) { return true; };
    const auto rows = convergenceRows(extent);
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 4u);
    for (const Row& row : *rows) {
        const bool smooth = row.method == kCellOnSmooth || row.method == kSpacingOnSmooth;
        const double derived = smooth ? 2.0 : row.method == kCellAtEdges ? 1.0 : 4.0 / 3.0;
        EXPECT_NEAR(row.order, derived, 0.25) << row.method << ": " << row.settings;
        std::printf("%-40s order %.2f; %s\n", row.method.c_str(), row.order, row.settings.c_str());
    }
}

}  // namespace
}  // namespace passung::bench
