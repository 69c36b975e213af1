#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/session/questionnaire_source.h"
#include "study/session/trial_sink.h"

namespace passung::session {

/// Whose questionnaires.
struct DeskKey {
    std::string participant;
    std::uint64_t seed = 0;  // of the study
    int ordinal = 1;
};

/// Asks a session's questionnaires between its trials: shows a form to the source until it is filled, scores and stores
/// it.
class QuestionnaireDesk {
public:
    /// `source`: who answers; may be null if the plan has no questionnaire. Everything outlives the desk.
    QuestionnaireDesk(const protocol::StudyPlan& plan, DeskKey key, QuestionnaireSource* source, TrialSink& sink);

    /// One look at what is due between the trial that was remembered last and the first one `to_do`: true while
    /// something is, so that the trial has to wait. Errors: an answer that its item does not offer, or what the sink
    /// refuses.
    Result<bool> ask(std::span<const design::PlannedTrial> to_do, std::int64_t session_ns);

    /// A trial is over; forms may ask about it from now on.
    void remember(FinishedTrial trial);

private:
    Form formOf(const Occasion& occasion) const;
    Result<Done> store(const Form& form, const FilledForm& filled, std::int64_t session_ns);

    const protocol::StudyPlan& plan_;
    DeskKey key_;
    QuestionnaireSource* source_;
    TrialSink& sink_;
    std::vector<FinishedTrial> finished_;
    std::size_t asked_ = 0;  // forms that are stored since
};

}  // namespace passung::session
