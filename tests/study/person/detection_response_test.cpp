#include "study/person/detection_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "study/person/completion_time.h"
#include "study/person/real_parts.h"

namespace passung::person {
namespace {

struct Summary {
    double missed = 0.0, mistaken = 0.0, mean_log = 0.0;
};

Summary answers(const SimulatedPerson& person, double load, int count) {
    Random random(11);
    Summary sum;
    for (int i = 0; i < count; ++i) {
        const DetectionResponse response = respond(person, load, random);
        if (!response.press) ++sum.missed;
        if (response.press) sum.mean_log += std::log(*response.press);
        if (response.mistake) ++sum.mistaken;
    }
    sum.mean_log /= count - sum.missed;
    return {sum.missed / count, sum.mistaken / count, sum.mean_log};
}

TEST(DetectionResponse, FollowsItsStatedModel) {
    // Truth: closed form: shares within 4 standard errors of 20000 draws, 4 sqrt(p (1 - p) / n); the mean of the
    // logarithm within 4 · 0.2 / sqrt(n).
    SimulatedPerson person;
    constexpr int kCount = 20000;
    for (const double load : {0.0, 0.5, 1.0}) {
        const Summary seen = answers(person, load, kCount);
        const double miss = person.miss_rate * (1.0 + 2.0 * load);
        EXPECT_NEAR(seen.missed, miss, 4.0 * std::sqrt(miss * (1.0 - miss) / kCount));
        EXPECT_NEAR(seen.mistaken, 0.03, 4.0 * std::sqrt(0.03 * 0.97 / kCount));
        EXPECT_NEAR(seen.mean_log, std::log(person.reaction_time * (1.0 + person.reaction_load * load)),
                    4.0 * 0.2 / std::sqrt(0.8 * kCount));
    }
}

TEST(RealTrial, IsHalfAVirtualOneAndTheExperimentersReaction) {
    // Truth: closed form: mean 0.5 · mean of completionTime() + 0.25 s, over the same number of draws; the standard
    // deviation of either is below 1 s, so that 4 standard errors of 5000 draws are below 0.06 s.
    SimulatedPerson person;
    person.lapse_rate = 0.05;
    Random real(3), virtual_parts(4);
    double sum = 0.0, sum_virtual = 0.0, dropped = 0.0;
    constexpr int kCount = 5000;
    for (int i = 0; i < kCount; ++i) {
        const RealTrial trial = realTrial(person, 20, real);
        EXPECT_GT(trial.time, 0.1);
        sum += trial.time;
        dropped += trial.success ? 0.0 : 1.0;
        sum_virtual += completionTime(person, 20, virtual_parts);
    }
    EXPECT_NEAR(sum / kCount, 0.5 * sum_virtual / kCount + 0.25, 0.06);
    EXPECT_NEAR(dropped / kCount, 0.01, 4.0 * std::sqrt(0.01 * 0.99 / kCount));
}

}  // namespace
}  // namespace passung::person
