#pragma once

#include "core/base/json.h"
#include "core/base/regular_file.h"
#include "study/protocol/questionnaire_reader.h"
#include "study/questionnaire/scoring.h"
#include "tests/study/store/fake_study.h"

/// The fake study with shipped questionnaires, for tests of store and export.
namespace passung::fake {

inline plan::PlannedQuestionnaire shippedQuestionnaire(const std::string& key, plan::Moment moment) {
    const std::string path = PASSUNG_SOURCE_DIR "/protocols/questionnaires/" + key + ".toml";
    const std::string text = *readFile(path);
    plan::PlannedQuestionnaire planned;
    planned.language = "de";
    planned.moment = moment;
    planned.definition = *protocol::readQuestionnaire(text, path, "de");
    planned.source_json = JsonObject().text("definition", text).str();
    return planned;
}

/// Contact perception after each condition, demographics at the end.
inline plan::StudyPlan makeAskingPlan() {
    plan::StudyPlan plan = makePlan();
    plan.source_text += "# asks\n";
    plan.questionnaires = {shippedQuestionnaire("contact_perception", plan::Moment::AfterCondition),
                           shippedQuestionnaire("demographics", plan::Moment::SessionEnd)};
    plan.expanded_json = R"({"questionnaires": ["contact_perception", "demographics"]})";
    return plan;
}

inline std::unique_ptr<store::SessionWriter> beginAskingSession(
    store::Store& store, const plan::StudyPlan& plan, const std::string& participant, std::int64_t trials,
    plan::ParticipantKind kind = plan::ParticipantKind::Simulated) {
    store::SessionStart start;
    start.protocol_sha256 = require(store.importProtocol(plan));
    require(store.enrol(participant, kind, store::UtcClock::virtualEpoch().at(0)));
    require(store.assignSlot(start.protocol_sha256, participant));
    start.participant = participant;
    start.seed = plan.seed;
    start.session_id = store::sessionId(plan.name, participant, 1, start.seed);
    start.device.name = "sigma7";
    return require(store.createSession(start, makeTrials(plan, trials)));
}

/// Stores a filled form: `numbers` in the order of the items, shown last item first; none for a skipped one.
inline Result<Done> storeForm(store::SessionWriter& writer, const plan::StudyPlan& plan,
                              const session::Occasion& occasion, const std::vector<std::optional<double>>& numbers,
                              std::int64_t time_ns, const std::string& text = "") {
    const auto& planned = plan.questionnaires.at(occasion.questionnaire);
    session::ShownQuestionnaire form{planned, occasion, "", {}, {}};
    session::FilledForm filled{{}, "participant"};
    std::vector<questionnaire::Answer> answers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        form.order.push_back(numbers.size() - 1 - i);
        answers.push_back({numbers[i], ""});
        if (planned.definition.items[i].response.kind == questionnaire::AnswerKind::Text) answers[i].text = text;
        filled.answers.push_back({answers[i], 700 + static_cast<std::int64_t>(i), 2});
    }
    return writer.storeQuestionnaire(
        {form, filled, questionnaire::computeScores(planned.definition, answers), time_ns, time_ns});
}

}  // namespace passung::fake
