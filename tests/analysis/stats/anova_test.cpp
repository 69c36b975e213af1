#include "analysis/stats/anova.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "analysis/stats/paired_t.h"

namespace passung::stats {
namespace {

using Values = std::vector<double>;
using Rows = std::vector<Values>;

const Rows kRows = {{4.1, 5.0, 6.3}, {3.2, 3.9, 3.8}, {5.5, 5.1, 7.0}, {2.7, 4.4, 4.9}, {4.0, 4.2, 6.6}};

double upperTail(double f, double df1, double df2) {
    return boost::math::cdf(boost::math::complement(boost::math::fisher_f(df1, df2), f));
}

TEST(WelchT, AllowsForUnequalVariances) {
    // Truth: independent program (R, t.test(extra ~ group, data = sleep)): t = -1.8608, df = 17.776, p = 0.07939.
    const Values one = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
    const Values two = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
    EXPECT_NEAR(welchT(one, two).statistic, -1.8608, 5e-5);
    EXPECT_NEAR(welchT(one, two).p, 0.07939, 5e-6);
    EXPECT_TRUE(std::isnan(welchT(one, Values{1}).p));
    EXPECT_TRUE(std::isnan(welchT(Values{1, 1}, Values{1, 1}).p));
}

TEST(OneWayAnova, ComparesMeansWithTheVarianceWithin) {
    // Truth: independent program (R, anova(lm(weight ~ group, PlantGrowth))): F = 4.8461, p = 0.01591.
    const Rows weights = {{4.17, 5.58, 5.18, 6.11, 4.50, 4.61, 5.17, 4.53, 5.33, 5.14},
                          {4.81, 4.17, 4.41, 3.59, 5.87, 3.83, 6.03, 4.89, 4.32, 4.69},
                          {6.31, 5.12, 5.54, 5.50, 5.37, 5.29, 4.92, 6.15, 5.80, 5.26}};
    EXPECT_NEAR(oneWayAnova(weights).statistic, 4.8461, 5e-5);
    EXPECT_NEAR(oneWayAnova(weights).p, 0.01591, 5e-6);
    EXPECT_TRUE(std::isnan(oneWayAnova({{1, 2}, {}}).p));
}

TEST(WithinAnova, IsThePairedTTestOfTwoLevels) {
    // Truth: closed form: F = t².
    Rows rows;
    Values differences;
    for (const Values& row : kRows) {
        rows.push_back({row[0], row[1]});
        differences.push_back(row[0] - row[1]);
    }
    const PairedT paired = pairedT(differences);
    EXPECT_NEAR(withinAnova({rows}).statistic, paired.t * paired.t, 1e-9);
    EXPECT_NEAR(withinAnova({rows}).p, paired.p, 1e-12);
}

TEST(WithinAnova, HasTheSumsOfSquaresOfTheTwoWayTable) {
    // Truth: closed form: deviations of the levels' means, and what persons' and levels' means leave over.
    double grand = 0.0, between = 0.0, rest = 0.0;
    Values level(3, 0.0), person(kRows.size(), 0.0);
    for (std::size_t i = 0; i < kRows.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            level[k] += kRows[i][k] / 5.0;
            person[i] += kRows[i][k] / 3.0;
            grand += kRows[i][k] / 15.0;
        }
    for (std::size_t i = 0; i < kRows.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            between += (level[k] - grand) * (level[k] - grand);
            rest += std::pow(kRows[i][k] - level[k] - person[i] + grand, 2);
        }
    const double f = (between / 2.0) / (rest / 8.0);
    EXPECT_NEAR(withinAnova({kRows}).statistic, f, 1e-9);
    const double p = withinAnova({kRows}).p;
    EXPECT_GT(p, upperTail(f, 2, 8)) << "some deviation from sphericity";
    EXPECT_LT(p, upperTail(f, 1, 4)) << "the least that epsilon can be";
    Rows turned;
    for (const Values& row : kRows) turned.push_back({row[2], row[0], row[1]});
    EXPECT_NEAR(withinAnova({turned}).p, p, 1e-12) << "the order of the levels means nothing";
}

TEST(WithinAnova, EpsilonIsOneForSphericalAndLeastForOneDimensionalDifferences) {
    // Truth: closed form: residuals that are the three levels' permutations by turns have equal variances of all
    // differences (epsilon 1); residuals along one contrast have epsilon 1/2.
    Rows round, line;
    const Values shift = {0.0, 0.5, 1.5};
    for (const Values& pattern : {Values{1, -1, 0}, Values{0, 1, -1}, Values{-1, 0, 1}}) {
        for (const double sign : {1.0, -1.0}) {
            Values row;
            for (std::size_t k = 0; k < 3; ++k) row.push_back(shift[k] + sign * pattern[k]);
            round.push_back(row);
        }
    }
    const double size[] = {1.0, -2.0, 0.5, 0.7};
    for (const double s : size) line.push_back({0.0 + s, 0.5 - s, 1.5});
    const TestResult sphere = withinAnova({round}), one = withinAnova({line});
    EXPECT_NEAR(sphere.p, upperTail(sphere.statistic, 2, 10), 1e-12);
    EXPECT_NEAR(one.p, upperTail(one.statistic, 1, 3), 1e-12);
}

TEST(WithinAnova, GroupsOfAnyLevelDoNotMatterAndWeighAlike) {
    // Truth: closed form: of two levels in groups of 2 and 3 persons: t² of half the sum of both groups' mean
    // differences, its variance pooled with 3 degrees of freedom. Whole groups that lie higher change nothing.
    const std::vector<Rows> groups = {{{1, 2}, {4, 4.5}}, {{2, 2.5}, {3, 5}, {1, 1.2}}};
    const Values first = {1, 0.5}, second = {0.5, 2, 0.2};
    const double mean = 0.5 * (0.75 + 0.9);
    double squares = 0.0;
    for (const double d : first) squares += (d - 0.75) * (d - 0.75);
    for (const double d : second) squares += (d - 0.9) * (d - 0.9);
    const double t = mean / std::sqrt(squares / 3.0 * (1.0 / 2 + 1.0 / 3) / 4.0);
    EXPECT_NEAR(withinAnova(groups).statistic, t * t, 1e-9);
    EXPECT_NEAR(withinAnova(groups).p, upperTail(t * t, 1, 3), 1e-12);
    std::vector<Rows> higher = groups;
    for (Values& row : higher[1])
        for (double& value : row) value += 100.0;
    EXPECT_NEAR(withinAnova(higher).p, withinAnova(groups).p, 1e-9);
    EXPECT_TRUE(std::isnan(withinAnova({{{1, 2}}}).p)) << "one person";
    EXPECT_TRUE(std::isnan(withinAnova({groups[0], {}}).p));
}

}  // namespace
}  // namespace passung::stats
