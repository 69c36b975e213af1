#include "study/questionnaire/cronbach_alpha.h"

#include <gtest/gtest.h>

namespace passung::questionnaire {
namespace {

TEST(CronbachAlpha, IsThatOfR) {
    // Truth: independent program (R 4.2.2, psych::alpha of these five rows: 0.962838)
    const auto alpha = cronbachAlpha({{4, 5, 4}, {2, 3, 2}, {5, 5, 4}, {3, 3, 3}, {1, 2, 2}});
    EXPECT_NEAR(alpha.value(), 0.962838, 5e-7);
}

TEST(CronbachAlpha, IsZeroForItemsThatHaveNothingInCommonHoweverTheirSumsAreRounded) {
    // Truth: closed form: uncorrelated items: the variance of the sum is the sum of the variances. In doubles the two
    // differ in the last bit here.
    const double low = 1.1, high = low + 1.0 / 3.0;
    EXPECT_EQ(cronbachAlpha({{low, low}, {low, high}, {high, low}, {high, high}}).value(), 0.0);
}

TEST(CronbachAlpha, IsOneForEqualItemsAndAbsentWhereItIsNotDefined) {
    // Truth: closed form: k/(k-1) * (1 - k s^2 / (k^2 s^2)) = 1
    EXPECT_NEAR(cronbachAlpha({{1, 1, 1}, {4, 4, 4}, {2, 2, 2}}).value(), 1.0, 1e-12);
    EXPECT_FALSE(cronbachAlpha({}));
    EXPECT_FALSE(cronbachAlpha({{1, 2}})) << "one person";
    EXPECT_FALSE(cronbachAlpha({{1}, {2}})) << "one item";
    EXPECT_FALSE(cronbachAlpha({{1, 3}, {3, 1}})) << "sums that do not vary";
}

}  // namespace
}  // namespace passung::questionnaire
