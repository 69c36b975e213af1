#include "analysis/stats/probit_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace passung::stats {
namespace {

constexpr std::array<LevelCount, 6> kGolden{
    {{1, 2, 20}, {2, 4, 20}, {3, 9, 20}, {4, 13, 20}, {5, 18, 20}, {6, 19, 20}}};

TEST(ProbitFit, GivesWhatRGives) {
    // Truth: independent program (R 4.2.2, glm(cbind(k, n - k) ~ level, family = binomial(probit)); JND: qnorm(0.75)
    // sigma), to the six decimals that it was printed with.
    const auto fit = fitProbit(kGolden);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->intercept, -2.005043, 5e-7);
    EXPECT_NEAR(fit->slope, 0.620878, 5e-7);
    EXPECT_NEAR(fit->middle(), 3.229369, 5e-7);
    EXPECT_NEAR(fit->sigma(), 1.610623, 5e-7);
    EXPECT_NEAR(fit->jnd75(), 1.086349, 5e-7);
    EXPECT_NEAR(fit->deviance, 0.500785, 5e-7);
}

TEST(ProbitFit, MovesWithTheLevels) {
    // Truth: invariant: levels shifted and stretched shift and stretch the middle and stretch sigma.
    auto moved = kGolden;
    for (LevelCount& count : moved) count.level = 10.0 + 3.0 * count.level;
    const auto fit = fitProbit(kGolden), other = fitProbit(moved);
    ASSERT_TRUE(fit && other);
    EXPECT_NEAR(other->middle(), 10.0 + 3.0 * fit->middle(), 1e-9);
    EXPECT_NEAR(other->sigma(), 3.0 * fit->sigma(), 1e-9);
    EXPECT_NEAR(other->deviance, fit->deviance, 1e-9);
}

TEST(ProbitFit, ThereIsNoneWhereNoSlopeIsBest) {
    // Truth: closed form: answers that a step separates, and one level alone.
    EXPECT_FALSE(fitProbit(std::array<LevelCount, 2>{{{1, 0, 10}, {2, 10, 10}}}));
    EXPECT_FALSE(fitProbit(std::array<LevelCount, 1>{{{1, 5, 10}}}));
}

}  // namespace
}  // namespace passung::stats
