#include "study/person/perception.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace passung::person {
namespace {

TEST(Perception, IsANormalOgiveBetweenGuessAndLapse) {
    // Truth: closed form: the middle, and one sigma above it Phi(1) = 0.8413447461.
    const Perception perception{2.0, 0.5, 0.04};
    EXPECT_DOUBLE_EQ(perception.chance(2.0, 0.5), 0.5 + 0.46 / 2.0);
    EXPECT_NEAR(perception.chance(2.5, 0.5), 0.5 + 0.46 * 0.8413447461, 1e-10);
    EXPECT_NEAR(perception.chance(-20.0, 0.0), 0.0, 1e-12);
    EXPECT_NEAR(perception.chance(20.0, 0.0), 0.96, 1e-12);
}

TEST(Perception, AnswersComeAsOftenAsTheOgiveSays) {
    // Truth: closed form: 10 000 answers with chance p, p +- 4 sqrt(p (1 - p) / 10 000).
    const Perception perception{2.0, 0.5, 0.04};
    for (const double x : {1.0, 1.8, 2.6}) {
        Random random(5);
        int positive = 0;
        for (int i = 0; i < 10'000; ++i) positive += perceives(perception, x, 0.5, random) ? 1 : 0;
        const double p = perception.chance(x, 0.5);
        EXPECT_NEAR(positive / 1e4, p, 4.0 * std::sqrt(p * (1.0 - p) / 1e4)) << x;
    }
}

TEST(Perception, IsTheSamePersonsInEveryTrialAndAnotherPersonsElse) {
    // Truth: invariant
    const auto of = [](const char* code, const char* staircase) {
        return perceptionOf("study", code, 7, staircase, 1.0, 3.0);
    };
    EXPECT_EQ(of("S001", "a").threshold, of("S001", "a").threshold);
    EXPECT_NE(of("S001", "a").threshold, of("S002", "a").threshold);
    EXPECT_NE(of("S001", "a").threshold, of("S001", "b").threshold);
}

TEST(Perception, ThresholdsLieAboutTheMiddleOfTheAxis) {
    // Truth: closed form: mean 2 and standard deviation 0.2 of 1000 people (the clamp at 3 sigma hardly counts).
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double threshold = perceptionOf("study", "S" + std::to_string(i), 7, "a", 1.0, 3.0).threshold;
        EXPECT_GE(threshold, 1.4);
        EXPECT_LE(threshold, 2.6);
        sum += threshold;
        square += threshold * threshold;
    }
    EXPECT_NEAR(sum / 1000.0, 2.0, 4.0 * 0.2 / std::sqrt(1000.0));
    EXPECT_NEAR(std::sqrt(square / 1000.0 - std::pow(sum / 1000.0, 2)), 0.2, 4.0 * 0.2 / std::sqrt(2000.0));
}

}  // namespace
}  // namespace passung::person
