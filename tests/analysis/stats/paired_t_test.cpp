#include "analysis/stats/paired_t.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace passung::stats {
namespace {

/// Completion times [s] of ten participants without and with a cue of each kind, none first.
constexpr std::array<std::array<double, 4>, 10> kTimes = {{{42.1, 35.4, 38.9, 28.7},
                                                           {51.3, 52.2, 40.8, 47.5},
                                                           {38.6, 36.1, 39.2, 30.4},
                                                           {60.2, 49.8, 57.7, 33.9},
                                                           {45.0, 46.3, 41.6, 44.2},
                                                           {55.7, 46.9, 50.1, 52.0},
                                                           {47.4, 41.5, 44.6, 31.8},
                                                           {39.9, 42.2, 35.7, 41.3},
                                                           {58.8, 50.6, 55.4, 40.1},
                                                           {44.5, 44.5, 41.0, 46.6}}};

std::vector<double> differences(std::size_t a, std::size_t b) {
    std::vector<double> all;
    for (const auto& row : kTimes) all.push_back(row[a] - row[b]);
    return all;
}

TEST(PairedT, EqualsR) {
    // Truth: independent program (R 4.2.2, t.test(paired = TRUE)), printed to six decimals
    struct Row {
        std::size_t a, b;
        double mean, low, high, t, p;
    };
    for (const Row& row :
         {Row{0, 1, 3.80, 0.4094, 7.1906, 2.535337, 0.031954}, Row{0, 2, 3.85, 1.8396, 5.8604, 4.332045, 0.001899},
          Row{0, 3, 8.70, 1.9145, 15.4855, 2.900394, 0.017584}, Row{1, 2, 0.05, -4.3058, 4.4058, 0.025967, 0.979850},
          Row{1, 3, 4.90, 0.4252, 9.3748, 2.477122, 0.035157}, Row{2, 3, 4.85, -2.7976, 12.4976, 1.434626, 0.185215}}) {
        const PairedT test = pairedT(differences(row.a, row.b));
        EXPECT_EQ(test.n, 10u);
        EXPECT_NEAR(test.mean, row.mean, 1e-12);
        EXPECT_NEAR(test.t, row.t, 5e-7);
        EXPECT_NEAR(test.p, row.p, 5e-7);
        const Interval interval = meanInterval(test.n, test.mean, test.sd, 0.95);
        EXPECT_NEAR(interval.low, row.low, 5e-5);
        EXPECT_NEAR(interval.high, row.high, 5e-5);
        const PairedT turned = pairedT(differences(row.b, row.a));
        EXPECT_DOUBLE_EQ(turned.t, -test.t);
        EXPECT_DOUBLE_EQ(turned.p, test.p);
    }
}

TEST(PairedT, SaysWhereItIsNotDefined) {
    // Truth: closed form, the definition.
    EXPECT_TRUE(std::isnan(pairedT({}).mean));
    const PairedT one = pairedT(std::array{2.0});
    EXPECT_EQ(one.mean, 2.0);
    EXPECT_TRUE(std::isnan(one.sd) && std::isnan(one.t) && std::isnan(one.p));
    const PairedT nothing = pairedT(std::array{0.0, 0.0});
    EXPECT_EQ(nothing.sd, 0.0);
    EXPECT_TRUE(std::isnan(nothing.p));
    const PairedT certain = pairedT(std::array{0.5, 0.5});
    EXPECT_TRUE(std::isinf(certain.t));
    EXPECT_EQ(certain.p, 0.0);
}

TEST(PairedPower, HasThePowerAndTheSizeOfTheNonCentralT) {
    // Truth: independent program (R 4.2.2, package pwr: pwr.t.test(type = "paired")), printed digits
    EXPECT_NEAR(pairedPower(0.8, 12, 0.05), 0.713660, 5e-7);
    EXPECT_NEAR(pairedPower(-0.8, 12, 0.05), 0.713660, 5e-7);
    EXPECT_NEAR(pairedSize(0.5, 0.8, 0.05), 33.367, 5e-4);
}

TEST(PairedPower, OfNoEffectIsAlphaAndNoSizeReachesMore) {
    // Truth: closed form
    for (const double n : {2.0, 12.0, 500.0})
        for (const double alpha : {0.01, 0.05, 0.2}) EXPECT_NEAR(pairedPower(0.0, n, alpha), alpha, 1e-9);
    EXPECT_TRUE(std::isinf(pairedSize(0.0, 0.8, 0.05)));
    EXPECT_NEAR(pairedPower(0.3, pairedSize(0.3, 0.9, 0.01), 0.01), 0.9, 1e-7);
    EXPECT_NEAR(pairedSize(1e3, 0.8, 0.05), 2.0, 1e-9);
}

TEST(PairedPower, IsHowOftenTheTestFindsNormalDifferences) {
    // Truth: closed form against 4000 draws: standard error sqrt(0.7 · 0.3 / 4000) = 0.0072, of which 4 are allowed.
    Random random(3);
    int found = 0;
    for (int i = 0; i < 4000; ++i) {
        std::array<double, 12> sample;
        for (double& value : sample) value = 0.8 + random.normal();
        found += pairedT(sample).p < 0.05 ? 1 : 0;
    }
    EXPECT_NEAR(found / 4000.0, pairedPower(0.8, 12, 0.05), 4 * 0.0072);
}

}  // namespace
}  // namespace passung::stats
