#include "study/person/completion_time.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace passung;
using namespace passung::person;

namespace {

constexpr int kDraws = 20000;

/// Always the same pace, never absent.
SimulatedPerson steady() {
    SimulatedPerson person;
    person.learning = 0.0;
    person.lapse_rate = 0.0;
    return person;
}

double meanTime(const SimulatedPerson& person, std::int64_t trials_before) {
    Random random(5);
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) sum += completionTime(person, trials_before, random);
    return sum / kDraws;
}

TEST(CompletionTime, HasTheMomentsOfItsExGaussian) {
    // Truth: closed form: mean 2.6 + 0.6, variance 0.25² + 0.6², third moment 2 · 0.6³. Standard errors of the mean and
    // of the variance of 20000 draws: 0.0046 and, with the exponential's kurtosis of 9, 0.0074; 4 of them are allowed.
    Random random(1);
    double sum = 0.0, squares = 0.0, cubes = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        const double deviation = completionTime(steady(), 0, random) - 3.2;
        sum += deviation;
        squares += deviation * deviation;
        cubes += deviation * deviation * deviation;
    }
    EXPECT_NEAR(sum / kDraws, 0.0, 4 * 0.0046);
    EXPECT_NEAR(squares / kDraws, 0.4225, 4 * 0.0074);
    EXPECT_NEAR(cubes / kDraws, 0.432, 0.1);
}

TEST(CompletionTime, FollowsPacePracticeAndLapses) {
    // Truth: closed form against the same draws
    const double usual = meanTime(steady(), 0);
    SimulatedPerson fast = steady();
    fast.pace = 1.25;
    EXPECT_NEAR(meanTime(fast, 0), usual / 1.25, 1e-9);
    SimulatedPerson learner = steady();
    learner.learning = 0.4;
    learner.learning_trials = 5.0;
    EXPECT_NEAR(meanTime(learner, 0), 1.4 * usual, 1e-9);
    EXPECT_NEAR(meanTime(learner, 5), (1.0 + 0.4 / std::exp(1.0)) * usual, 1e-9);
    SimulatedPerson absent = steady();
    absent.lapse_rate = 1.0;
    absent.lapse_duration = 2.0;
    EXPECT_NEAR(meanTime(absent, 0), usual + 2.0, 1e-9);
    absent.lapse_rate = 0.1;  // 4 standard deviations of 20000 draws of 2 s at 0.1: 0.017
    EXPECT_NEAR(meanTime(absent, 0), usual + 0.2, 0.017);
}

}  // namespace
