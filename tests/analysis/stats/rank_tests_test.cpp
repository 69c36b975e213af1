#include "analysis/stats/rank_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace passung::stats {
namespace {

using Values = std::vector<double>;

/// Two-sided p of the signed-rank test over all 2^n ways to sign the ranks.
double enumeratedSigns(const Values& differences) {
    Values sorted;
    for (const double d : differences) sorted.push_back(std::abs(d));
    std::sort(sorted.begin(), sorted.end());
    const auto rank = [&](double d) {
        return static_cast<double>(std::find(sorted.begin(), sorted.end(), std::abs(d)) - sorted.begin() + 1);
    };
    double observed = 0.0, below = 0.0, above = 0.0;
    for (const double d : differences) observed += d > 0.0 ? rank(d) : 0.0;
    const std::size_t ways = std::size_t{1} << differences.size();
    for (std::size_t way = 0; way < ways; ++way) {
        double sum = 0.0;
        for (std::size_t i = 0; i < differences.size(); ++i)
            sum += (way >> i & 1) != 0 ? static_cast<double>(i + 1) : 0;
        below += sum <= observed ? 1.0 : 0.0;
        above += sum >= observed ? 1.0 : 0.0;
    }
    return std::min(1.0, 2.0 * std::min(below, above) / static_cast<double>(ways));
}

/// Two-sided p of the two-sample test over all ways to choose which ranks are of the first sample.
double enumeratedOrders(const Values& a, const Values& b) {
    std::vector<int> first(a.size() + b.size(), 0);
    std::fill(first.end() - static_cast<std::ptrdiff_t>(a.size()), first.end(), 1);
    double observed = 0.0, below = 0.0, above = 0.0, ways = 0.0;
    for (const double x : a)
        for (const double y : b) observed += x > y ? 1.0 : 0.0;
    do {
        double u = 0.0, seconds = 0.0;
        for (const int is_first : first) is_first ? u += seconds : seconds += 1.0;
        below += u <= observed ? 1.0 : 0.0;
        above += u >= observed ? 1.0 : 0.0;
        ways += 1.0;
    } while (std::next_permutation(first.begin(), first.end()));
    return std::min(1.0, 2.0 * std::min(below, above) / ways);
}

TEST(SignedRank, IsExactForFewDifferencesWithoutTies) {
    // Truth: closed form: all ways to sign the ranks; and Hollander and Wolfe's depression scores (V = 40 of 45, one
    // side p = 0.01953).
    const Values scores = {0.952, -0.147, 1.022, 0.43, 0.62, 0.59, 0.49, -0.08, 0.01};
    EXPECT_EQ(wilcoxonSignedRank(scores).statistic, 40.0);
    EXPECT_NEAR(wilcoxonSignedRank(scores).p, 2 * 0.01953125, 1e-12);
    for (const Values& differences :
         {Values{1}, Values{-1, 2}, Values{3, -1, 4, 1.5, -5}, Values{-1, -2, -3, -4, 5, 6}, scores})
        EXPECT_NEAR(wilcoxonSignedRank(differences).p, enumeratedSigns(differences), 1e-12);
    EXPECT_TRUE(std::isnan(wilcoxonSignedRank(Values{0, 0}).p));
}

TEST(SignedRank, TiesAreRankedByTheirMean) {
    // Truth: closed form: |d| 1, 1, 2, 2, 2 have the ranks 1.5, 1.5, 4, 4, 4; the variance is 5·6·11/24 - (6 + 24)/48.
    const TestResult test = wilcoxonSignedRank(Values{1, -1, 2, 2, 2});
    EXPECT_EQ(test.statistic, 13.5);
    const double z = (13.5 - 7.5 - 0.5) / std::sqrt(5 * 6 * 11 / 24.0 - 30.0 / 48.0);
    EXPECT_NEAR(test.p, std::erfc(z / std::sqrt(2.0)), 1e-12);
}

TEST(MannWhitney, IsExactForFewValuesWithoutTies) {
    // Truth: closed form: all orders of the two samples.
    const Values a = {1.1, 5.2, 3.3}, b = {2.4, 6.5, 7.6, 8.7, 0.8}, c = {10, 11, 12, 13};
    for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a), std::pair(a, c), std::pair(c, b)})
        EXPECT_NEAR(mannWhitney(one, other).p, enumeratedOrders(one, other), 1e-12);
    EXPECT_EQ(mannWhitney(a, c).statistic, 0.0);
    EXPECT_NEAR(mannWhitney(a, c).p, 2.0 / 35.0, 1e-12) << "one of 7 over 3 orders, on either side";
}

TEST(MannWhitney, TiesAreRankedByTheirMean) {
    // Truth: independent program (R, wilcox.test(extra ~ group, data = sleep), correct = TRUE): W = 25.5, p = 0.06933.
    const Values one = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
    const Values two = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
    EXPECT_EQ(mannWhitney(one, two).statistic, 25.5);
    EXPECT_NEAR(mannWhitney(one, two).p, 0.06933, 5e-6);
    EXPECT_TRUE(std::isnan(mannWhitney(Values{1, 1}, Values{1}).p));
    EXPECT_TRUE(std::isnan(mannWhitney(Values{}, Values{1}).p));
}

TEST(Friedman, ComparesRanksWithinBlocks) {
    // Truth: independent program (R, friedman.test on Hollander and Wolfe's rounding times): 11.143, p = 0.003805;
    // closed form: with two treatments it is the squared normal score of the sign test.
    const std::vector<Values> times = {{5.40, 5.50, 5.55}, {5.85, 5.70, 5.75}, {5.20, 5.60, 5.50}, {5.55, 5.50, 5.40},
                                       {5.90, 5.85, 5.70}, {5.45, 5.55, 5.60}, {5.40, 5.40, 5.35}, {5.45, 5.50, 5.35},
                                       {5.25, 5.15, 5.00}, {5.85, 5.80, 5.70}, {5.25, 5.20, 5.10}, {5.65, 5.55, 5.45},
                                       {5.60, 5.35, 5.45}, {5.05, 5.00, 4.95}, {5.50, 5.50, 5.40}, {5.45, 5.55, 5.50},
                                       {5.55, 5.55, 5.35}, {5.45, 5.50, 5.55}, {5.50, 5.45, 5.25}, {5.65, 5.60, 5.40},
                                       {5.70, 5.65, 5.55}, {6.30, 6.30, 6.25}};
    EXPECT_NEAR(friedman(times).statistic, 11.143, 5e-4);
    EXPECT_NEAR(friedman(times).p, 0.003805, 5e-7);
    const std::vector<Values> two = {{1, 2}, {1, 2}, {1, 2}, {1, 2}, {2, 1}, {1, 2}};
    EXPECT_NEAR(friedman(two).statistic, (5.0 - 1.0) * (5.0 - 1.0) / 6.0, 1e-12);
    EXPECT_TRUE(std::isnan(friedman({{1, 1}, {2, 2}}).p)) << "no ranks";
    EXPECT_TRUE(std::isnan(friedman({{1, 2}}).p));
}

}  // namespace
}  // namespace passung::stats
