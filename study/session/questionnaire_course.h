#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/session/questionnaire_source.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// Whose questionnaires.
struct QuestionnaireKey {
    std::string participant;  // whose draws: plan::rehearsedCode()
    std::uint64_t seed = 0;   // of the study
    int ordinal = 1;
    bool timing_measured = true;  // false in virtual time: response times are not kept
};

/// Asks a session's questionnaires between its trials: shows a form to the source until it is filled, scores and stores
/// it.
class QuestionnaireCourse {
public:
    /// `source`: who answers; may be null if the plan has no questionnaire. Everything outlives the course.
    QuestionnaireCourse(const plan::StudyPlan& plan, QuestionnaireKey key, QuestionnaireSource* source,
                        TrialSink& sink);

    /// Checks once what is due between the trial that was remembered last and the first one `to_do`: true while
    /// something is, so that the trial has to wait. Errors: an answer that its item does not offer, or what the sink
    /// refuses.
    Result<bool> ask(std::span<const design::PlannedTrial> to_do, std::int64_t session_ns);

    /// Tells whether anything is due. Nothing is shown.
    bool isDue(std::span<const design::PlannedTrial> to_do) const { return nextDue(to_do).has_value(); }

    /// A trial is over; forms may ask about it from now on.
    void remember(FinishedTrial trial);

    /// The trial is to be done again: what was answered about it will be asked again afterwards.
    void forget(const design::PlannedTrial& trial);

    /// Goes on where an earlier run of the session was cut off: its trials that are over, those that are not, and the
    /// forms that were filled. A form about a trial that was begun again since then does not count.
    void resume(std::vector<FinishedTrial> finished, std::span<const design::PlannedTrial> to_do,
                const std::vector<StoredForm>& forms);

private:
    std::optional<ShownQuestionnaire> nextDue(std::span<const design::PlannedTrial> to_do) const;
    std::set<std::string> formsAbout(const design::PlannedTrial& trial) const;  // ids
    void noteShown(const ShownQuestionnaire& form, std::int64_t session_ns);
    ShownQuestionnaire formOf(const Occasion& occasion) const;
    Result<Done> store(const ShownQuestionnaire& form, const FilledForm& filled, std::int64_t session_ns);

    const plan::StudyPlan& plan_;
    QuestionnaireKey key_;
    QuestionnaireSource* source_;
    TrialSink& sink_;
    std::vector<FinishedTrial> finished_;
    std::set<std::string> answered_;  // ids of the forms that are stored and count
    std::string shown_;               // id of the form that is shown; empty: none
};

}  // namespace passung::session
