#include "study/session/questionnaire_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "core/base/json.h"
#include "core/base/random.h"
#include "study/questionnaire/presented_order.h"
#include "study/session/questionnaire_moments.h"

namespace passung::session {
namespace {

/// Of the session's number, moment, block, trial and condition; what there is not is empty.
std::string textOf(const Occasion& occasion, const plan::PlannedQuestionnaire& planned, int ordinal) {
    const auto text = [](const auto& number) { return number ? fmt::format("{}", *number) : std::string(); };
    return fmt::format("{}|{}|{}|{}|{}", ordinal, plan::momentName(planned.moment), text(occasion.block_index),
                       text(occasion.trial_index), text(occasion.condition));
}

Error faultOf(const ShownQuestionnaire& form, std::string message) {
    Error error;
    error.key = "questionnaire " + form.planned.definition.key;
    error.message = std::move(message);
    return error;
}

}  // namespace

QuestionnaireCourse::QuestionnaireCourse(const plan::StudyPlan& plan, QuestionnaireKey key, QuestionnaireSource* source,
                                         TrialSink& sink)
    : plan_(plan), key_(std::move(key)), source_(source), sink_(sink) {}

void QuestionnaireCourse::remember(FinishedTrial trial) { finished_.push_back(std::move(trial)); }

void QuestionnaireCourse::forget(const design::PlannedTrial& trial) {
    std::erase_if(finished_, [&](const FinishedTrial& f) { return f.trial.trial_index == trial.trial_index; });
    for (const std::string& id : formsAbout(trial)) answered_.erase(id);
}

void QuestionnaireCourse::resume(std::vector<FinishedTrial> finished, std::span<const design::PlannedTrial> to_do,
                                 const std::vector<StoredForm>& forms) {
    finished_ = std::move(finished);
    std::map<std::string, std::int64_t> begun_ns;  // the newest trial of those that a form is about
    for (const FinishedTrial& trial : finished_)
        for (const std::string& id : formsAbout(trial.trial)) begun_ns[id] = std::max(begun_ns[id], trial.begun_ns);
    for (const design::PlannedTrial& trial : to_do)
        for (const std::string& id : formsAbout(trial)) begun_ns[id] = std::numeric_limits<std::int64_t>::max();
    for (const StoredForm& form : forms) {
        const auto begun = begun_ns.find(form.id);
        if (begun == begun_ns.end() || form.t_ns > begun->second) answered_.insert(form.id);
    }
}

std::set<std::string> QuestionnaireCourse::formsAbout(const design::PlannedTrial& trial) const {
    std::set<std::string> ids;
    for (const Occasion& occasion : occasionsAbout(plan_, trial))
        ids.insert(formId(occasion, textOf(occasion, plan_.questionnaires[occasion.questionnaire], key_.ordinal)));
    return ids;
}

std::optional<ShownQuestionnaire> QuestionnaireCourse::nextDue(std::span<const design::PlannedTrial> to_do) const {
    for (const Occasion& due : occasionsBetween(plan_, finished_.empty() ? nullptr : &finished_.back().trial, to_do)) {
        ShownQuestionnaire form = formOf(due);
        if (answered_.count(form.id()) == 0) return form;
    }
    return std::nullopt;
}

Result<bool> QuestionnaireCourse::ask(std::span<const design::PlannedTrial> to_do, std::int64_t session_ns) {
    const auto form = nextDue(to_do);
    if (!shown_.empty() && (!form || form->id() != shown_)) {  // the experimenter went elsewhere
        shown_.clear();
        source_->withdraw();
    }
    if (!form) return false;
    if (source_ == nullptr || form->planned.definition.items.empty())
        return faultOf(*form, source_ == nullptr ? "nobody is there to answer it" : "its file has not been read");
    noteShown(*form, session_ns);
    auto filled = source_->fill(*form);
    if (!filled) return true;
    if (!key_.timing_measured)
        for (ItemAnswer& answer : filled->answers) answer.response_ms.reset();
    if (const auto stored = store(*form, *filled, session_ns); !stored) return stored.errors();
    answered_.insert(form->id());
    shown_.clear();
    return isDue(to_do);
}

/// The first time that it is.
void QuestionnaireCourse::noteShown(const ShownQuestionnaire& form, std::int64_t session_ns) {
    if (std::exchange(shown_, form.id()) == form.id()) return;
    sink_.appendEvent(
        {.attempt = {},
         .t_ns = session_ns,
         .source = "session",
         .event = "questionnaire_shown",
         .payload_json =
             JsonObject().text("questionnaire", form.planned.definition.key).text("form", form.id()).str()});
}

ShownQuestionnaire QuestionnaireCourse::formOf(const Occasion& occasion) const {
    const plan::PlannedQuestionnaire& planned = plan_.questionnaires[occasion.questionnaire];
    ShownQuestionnaire form{planned, occasion, textOf(occasion, planned, key_.ordinal), {}, {}};
    const std::uint64_t seed =
        streamSeed(plan_.name, key_.participant, planned.definition.key, "item_order|" + form.occasion_text, key_.seed);
    form.order = questionnaire::presentedOrder(planned.definition, seed);
    for (const FinishedTrial& finished : finished_)
        if (isAbout(plan_, occasion, finished.trial)) form.trials.push_back(&finished);
    return form;
}

Result<Done> QuestionnaireCourse::store(const ShownQuestionnaire& form, const FilledForm& filled,
                                        std::int64_t session_ns) {
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
