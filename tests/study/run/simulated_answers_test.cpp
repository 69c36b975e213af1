#include "study/run/person/simulated_answers.h"
#include "study/run/files/known_names.h"

#include <gtest/gtest.h>

#include "study/protocol/protocol_reader.h"

namespace passung::run {
namespace {

plan::StudyPlan shippedStudy() {
    auto plan =
        protocol::readProtocol(PASSUNG_SOURCE_DIR "/protocols/peg_in_hole/study.toml", knownDevices(), knownMeasures());
    if (!plan) throw std::runtime_error(toString(plan.errors().front()));
    return *std::move(plan);
}

TEST(SimulatedAnswers, AFormsTrialsDecideAndNothingElse) {
    // Truth: invariant: of two forms that differ in the trials' outcome only, the failure is rated as worse
    // performance.
    const auto plan = shippedStudy();
    const session::FinishedTrial good{{}, {{"success", 1.0}, {"mean_force_N", 2.0}}};
    const session::FinishedTrial bad{{}, {{"success", 0.0}, {"mean_force_N", 2.0}}};
    const auto performance = [&](const session::FinishedTrial& trial) {
        const session::ShownQuestionnaire form{
            plan.questionnaires[0], {}, "1|after_block|1||", {0, 1, 2, 3, 4, 5}, {&trial, &trial}};
        const auto filled = SimulatedAnswers(plan, "S001").fill(form);
        EXPECT_EQ(filled->answered_by, "simulated");
        EXPECT_FALSE(filled->answers[3].response_ms);
        return filled->answers[3].answer.number.value();
    };
    EXPECT_GT(performance(bad), performance(good) + 30.0);
    EXPECT_EQ(performance(bad), performance(bad));
}

}  // namespace
}  // namespace passung::run
