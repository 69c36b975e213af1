#include "ui/app/simulated_perception.h"
#include "ui/app/known_names.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "study/protocol/protocol_reader.h"
#include "study/session/participant_order.h"
#include "study/session/staircases.h"

namespace passung::app {
namespace {

TEST(SimulatedPerception, TheShippedStaircaseFindsTheThresholdsOfItsPeople) {
    // Truth: closed form: each person's own threshold. Over 200 people the mean error is below a twentieth of a sigma
    // but for its own spread (4 standard errors), and the people are told apart.
    const auto plan = protocol::readProtocol(PASSUNG_SOURCE_DIR "/protocols/accuracy_threshold/study.toml",
                                             presetDevices(), knownMeasures());
    ASSERT_TRUE(plan) << toString(plan.errors().front());
    constexpr int kPeople = 200;
    double error = 0.0, square = 0.0, sigma = 0.0, spread = 0.0, mean = 0.0;
    for (int i = 0; i < kPeople; ++i) {
        const std::string code = "S" + std::to_string(i + 1);
        const SimulatedPerception person(*plan, code);
        session::Staircases staircases(*plan, code, plan->seed, 1);
        std::optional<double> estimate;
        const auto trials = session::planTrials(*plan, {}, code);
        ASSERT_TRUE(trials);
        for (const auto& trial : *trials) {
            const auto step = staircases.next(trial);
            if (!step) break;
            const auto noticed = person.notices(plan->conditions[step->condition], trial.trial_index, 0.5);
            ASSERT_TRUE(noticed);
            const auto answer = staircases.take(session::AttemptId{trial.trial_index}, trial, *step,
                                                {{"correct", *noticed ? 1.0 : 0.0}}, true);
            if (answer.estimate) estimate = std::log10(*answer.estimate);
        }
        ASSERT_TRUE(estimate);
        const auto truth = person.of(0);
        error += (*estimate - truth.threshold) / kPeople;
        square += std::pow(*estimate - truth.threshold, 2) / kPeople;
        sigma += truth.sigma / kPeople;
        mean += truth.threshold / kPeople;
        spread += truth.threshold * truth.threshold / kPeople;
    }
    std::printf("mean error %.1f %% of sigma, root mean square %.3f decades, people's spread %.3f\n",
                100.0 * error / sigma, std::sqrt(square), std::sqrt(spread - mean * mean));
    EXPECT_LT(std::abs(error), 0.05 * sigma + 4.0 * std::sqrt(square / kPeople));
    EXPECT_LT(std::sqrt(square), std::sqrt(spread - mean * mean)) << "the middle of the axis would be as good a guess";
}

}  // namespace
}  // namespace passung::app
