#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/design/trial_order.h"
#include "study/measures/measures.h"
#include "study/plan/study_plan.h"
#include "study/questionnaire/definition.h"
#include "study/questionnaire/scoring.h"

namespace passung::session {

/// A trial that is over, as a questionnaire may ask about it.
struct FinishedTrial {
    design::PlannedTrial trial;
    std::vector<measures::Value> measures;
    std::int64_t begun_ns = 0;  // session time
};

/// Moment at which a questionnaire is asked, and what about.
struct Occasion {
    std::size_t questionnaire = 0;            // index into the plan's
    std::optional<std::int64_t> block_index;  // empty: at the start or end of the session
    std::optional<std::int64_t> trial_index;  // after a trial
    std::optional<std::size_t> condition;     // after a trial or a condition
    friend bool operator==(const Occasion&, const Occasion&) = default;
};

/// What tells a form from every other one of the session, in this run of the program and later ones.
inline std::string formId(const Occasion& occasion, const std::string& occasion_text) {
    return std::to_string(occasion.questionnaire) + "|" + occasion_text;
}

/// A questionnaire as it is to be shown.
struct ShownQuestionnaire {
    const plan::PlannedQuestionnaire& planned;
    Occasion occasion;
    std::string occasion_text;                 // unique in the study for a participant; part of random streams
    std::vector<std::size_t> order;            // items as presented
    std::vector<const FinishedTrial*> trials;  // that it is about: of the trial, condition, block or session before it

    std::string id() const { return formId(occasion, occasion_text); }
};

struct ItemAnswer {
    questionnaire::Answer answer;
    std::optional<std::int64_t> response_ms;  // from showing the item to its last answer; empty: not measured
    int changes = 0;                          // of an answer once given
};

struct FilledForm {
    std::vector<ItemAnswer> answers;  // one for each item, in the order of the definition
    std::string answered_by;          // "participant", "experimenter" (who read it out), "simulated"
};

/// Interface to whoever answers questionnaires.
class QuestionnaireSource {
public:
    virtual ~QuestionnaireSource() = default;
    /// The answers; nothing while the person is still at it. Called again and again with the same form, returns
    /// quickly.
    virtual std::optional<FilledForm> fill(const ShownQuestionnaire& form) = 0;
    /// The form of the last call is not to be filled now: whoever shows it takes it away.
    virtual void withdraw() {}
};

/// A questionnaire that an earlier part of the session stored.
struct StoredForm {
    std::string id;         // Form::id()
    std::int64_t t_ns = 0;  // session time
};

/// A form with its answers and scores, to be stored.
struct QuestionnaireRun {
    const ShownQuestionnaire& form;
    const FilledForm& filled;
    std::vector<questionnaire::Score> scores;
    std::int64_t started_ns = 0, completed_ns = 0;  // session time, which stands still meanwhile
};

}  // namespace passung::session
