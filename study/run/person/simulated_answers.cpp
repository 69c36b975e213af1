#include "study/run/person/simulated_answers.h"

#include <utility>

#include "core/base/random.h"
#include "study/questionnaire/definition.h"

namespace passung::run {
namespace {

/// Mean of a measure over the trials for which it is defined; `absent` if there is none.
double meanOf(const std::vector<const session::FinishedTrial*>& trials, std::string_view measure, double absent) {
    double sum = 0.0, count = 0.0;
    for (const session::FinishedTrial* trial : trials)
        for (const measures::Value& value : trial->measures)
            if (value.name == measure && value.value) {
                sum += *value.value;
                count += 1.0;
            }
    return count > 0.0 ? sum / count : absent;
}

person::Experience experienceOf(const session::ShownQuestionnaire& form) {
    if (form.trials.empty()) return {};
    // Without contact there was no force and no depth.
    return person::experienceOf(meanOf(form.trials, "mean_force_N", 0.0), meanOf(form.trials, "trial_time_s", 0.0),
                                1.0 - meanOf(form.trials, "success", 0.0),
                                meanOf(form.trials, "mean_hand_depth_m", 0.0));
}

}  // namespace

SimulatedAnswers::SimulatedAnswers(const plan::StudyPlan& plan, std::string participant)
    : plan_(plan),
      participant_(std::move(participant)),
      style_(person::drawRatingStyle(streamSeed(plan.name, participant_, "rating", "simulated", plan.seed))) {}

std::optional<session::FilledForm> SimulatedAnswers::fill(const session::ShownQuestionnaire& form) {
    const auto& definition = form.planned.definition;
    const std::uint64_t seed =
        streamSeed(plan_.name, participant_, definition.key, "simulated|" + form.occasion_text, plan_.seed);
    session::FilledForm filled{{}, "simulated"};
    for (auto& answer : person::answerItems(definition, form.order, experienceOf(form), style_, seed))
        filled.answers.push_back({std::move(answer), {}, 0});
    return filled;
}

}  // namespace passung::run
