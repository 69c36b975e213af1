#include "study/session/questionnaire_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/random.h"
#include "study/questionnaire/presented_order.h"
#include "study/session/questionnaire_moments.h"

namespace passung::session {
namespace {

/// Of the session's number, moment, block, trial and condition; what there is not is empty.
std::string textOf(const Occasion& occasion, const protocol::PlannedQuestionnaire& planned, int ordinal) {
    const auto text = [](const auto& number) { return number ? fmt::format("{}", *number) : std::string(); };
    return fmt::format("{}|{}|{}|{}|{}", ordinal, protocol::momentName(planned.moment), text(occasion.block_index),
                       text(occasion.trial_index), text(occasion.condition));
}

Error faultOf(const Form& form, std::string message) {
    Error error;
    error.key = "questionnaire " + form.planned.definition.key;
    error.message = std::move(message);
    return error;
}

}  // namespace

QuestionnaireDesk::QuestionnaireDesk(const protocol::StudyPlan& plan, DeskKey key, QuestionnaireSource* source,
                                     TrialSink& sink)
    : plan_(plan), key_(std::move(key)), source_(source), sink_(sink) {}

void QuestionnaireDesk::remember(FinishedTrial trial) {
    finished_.push_back(std::move(trial));
    answered_.clear();
}

void QuestionnaireDesk::resume(std::vector<FinishedTrial> finished, std::vector<std::string> answered) {
    finished_ = std::move(finished);
    answered_ = std::move(answered);
}

std::optional<Form> QuestionnaireDesk::nextDue(std::span<const design::PlannedTrial> to_do) const {
    for (const Occasion& due : occasionsBetween(plan_, finished_.empty() ? nullptr : &finished_.back().trial, to_do)) {
        Form form = formOf(due);
        if (std::find(answered_.begin(), answered_.end(), form.id()) == answered_.end()) return form;
    }
    return std::nullopt;
}

Result<bool> QuestionnaireDesk::ask(std::span<const design::PlannedTrial> to_do, std::int64_t session_ns) {
    const auto form = nextDue(to_do);
    if (!form) return false;
    if (source_ == nullptr || form->planned.definition.items.empty())
        return faultOf(*form, source_ == nullptr ? "nobody is there to answer it" : "its file has not been read");
    auto filled = source_->fill(*form);
    if (!filled) return true;
    if (!key_.timing_measured)
        for (ItemAnswer& answer : filled->answers) answer.response_ms.reset();
    if (const auto stored = store(*form, *filled, session_ns); !stored) return stored.errors();
    answered_.push_back(form->id());
    return isDue(to_do);
}

Form QuestionnaireDesk::formOf(const Occasion& occasion) const {
    const protocol::PlannedQuestionnaire& planned = plan_.questionnaires[occasion.questionnaire];
    Form form{planned, occasion, textOf(occasion, planned, key_.ordinal), {}, {}};
    const std::uint64_t seed =
        streamSeed(plan_.name, key_.participant, planned.definition.key, "item_order|" + form.occasion_text, key_.seed);
    form.order = questionnaire::presentedOrder(planned.definition, seed);
    for (const FinishedTrial& finished : finished_)
        if (isAbout(plan_, occasion, finished.trial)) form.trials.push_back(&finished);
    return form;
}

Result<Done> QuestionnaireDesk::store(const Form& form, const FilledForm& filled, std::int64_t session_ns) {
    const questionnaire::Definition& definition = form.planned.definition;
    if (filled.answers.size() != definition.items.size()) return faultOf(form, "not every item has an answer");
    std::vector<questionnaire::Answer> answers;
    for (std::size_t i = 0; i < definition.items.size(); ++i) {
        answers.push_back(filled.answers[i].answer);
        const auto fault = questionnaire::answerFault(definition.items[i], answers.back());
        if (!fault.empty()) return faultOf(form, fmt::format("item {}: {}", definition.items[i].id, fault));
    }
    return sink_.storeQuestionnaire(
        {form, filled, questionnaire::computeScores(definition, answers), session_ns, session_ns});
}

}  // namespace passung::session
