#pragma once

#include <string>

#include "study/person/simulated_answers.h"
#include "study/session/questionnaire_source.h"

namespace passung::run {

/// A simulated participant's answers, by what was rendered in the trials that a form is about (person::answerItems).
/// Answers at once; response times are not measured.
class SimulatedAnswers : public session::QuestionnaireSource {
public:
    /// The plan outlives this.
    SimulatedAnswers(const plan::StudyPlan& plan, std::string participant);

    std::optional<session::FilledForm> fill(const session::ShownQuestionnaire& form) override;

private:
    const plan::StudyPlan& plan_;
    std::string participant_;
    person::RatingStyle style_;
};

}  // namespace passung::run
