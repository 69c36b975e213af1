#include "study/store/rows/questionnaire_rows.h"

#include <stdexcept>

#include "core/base/digest.h"
#include "core/base/json.h"
#include "study/store/rows/event_rows.h"
#include "study/store/schema/named_columns.h"

namespace passung::store {
namespace {

using plan::PlannedQuestionnaire;

/// Everything that decides what was shown and how it was scored.
std::string definitionJson(const PlannedQuestionnaire& planned) {
    return JsonObject().text("language", planned.language).json("source", planned.source_json).str();
}

std::string digestOf(const PlannedQuestionnaire& planned) { return sha256Hex(definitionJson(planned)); }

void insertResponses(const Database& database, std::int64_t run_id, const session::QuestionnaireRun& run) {
    const auto& items = run.form.planned.definition.items;
    for (std::size_t shown = 0; shown < run.form.order.size(); ++shown) {
        const std::size_t i = run.form.order[shown];
        const session::ItemAnswer& given = run.filled.answers[i];
        const auto text = given.answer.text.empty() ? std::nullopt : std::optional(given.answer.text);
        insertRow(database, "item_response", Named{"run_id", run_id}, Named{"item", items[i].id},
                  Named{"presented_index", static_cast<std::int64_t>(shown)}, Named{"value_num", given.answer.number},
                  Named{"value_text", text}, Named{"skipped", given.answer.missing()},
                  Named{"rt_ms", given.response_ms}, Named{"changes", given.changes});
    }
}

void insertScores(const Database& database, std::int64_t run_id, const session::QuestionnaireRun& run) {
    const auto& definition = run.form.planned.definition;
    for (std::size_t i = 0; i < run.scores.size(); ++i)
        insertRow(database, "score", Named{"run_id", run_id}, Named{"scale", definition.scales[i].name},
                  Named{"value", run.scores[i].value}, Named{"n_items", static_cast<std::int64_t>(run.scores[i].items)},
                  Named{"n_missing", static_cast<std::int64_t>(run.scores[i].missing)},
                  Named{"scoring_version", definition.scoring_version});
}

/// Unless it is there.
void insertQuestionnaire(const Database& database, const PlannedQuestionnaire& planned) {
    const std::string json = definitionJson(planned), sha256 = sha256Hex(json);
    const auto& definition = planned.definition;
    insertRowIfNew(database, "questionnaire", Named{"questionnaire_sha256", sha256}, Named{"key", definition.key},
                   Named{"version", definition.version}, Named{"language", definition.language},
                   Named{"licence", definition.licence}, Named{"definition_json", json});
}

std::vector<ItemResponseRow> readResponses(const Database& database, std::int64_t run_id) {
    static const Selection<ItemResponseRow> columns = {
        {"item", &ItemResponseRow::item},           {"presented_index", &ItemResponseRow::presented_index},
        {"value_num", &ItemResponseRow::value_num}, {"value_text", &ItemResponseRow::value_text},
        {"skipped", &ItemResponseRow::skipped},     {"rt_ms", &ItemResponseRow::rt_ms},
        {"changes", &ItemResponseRow::changes}};
    Statement statement =
        database.prepare("SELECT " + columns.text() + " FROM item_response WHERE run_id=? ORDER BY presented_index");
    return columns.allOf(statement.bind(run_id));
}

std::vector<ScoreRow> readScores(const Database& database, std::int64_t run_id) {
    static const Selection<ScoreRow> columns = {{"scale", &ScoreRow::scale},
                                                {"value", &ScoreRow::value},
                                                {"n_items", &ScoreRow::n_items},
                                                {"n_missing", &ScoreRow::n_missing},
                                                {"scoring_version", &ScoreRow::scoring_version}};
    Statement statement = database.prepare("SELECT " + columns.text() + " FROM score WHERE run_id=? ORDER BY scale");
    return columns.allOf(statement.bind(run_id));
}

}  // namespace

void insertQuestionnaires(const Database& database, const plan::StudyPlan& plan) {
    for (const PlannedQuestionnaire& planned : plan.questionnaires) insertQuestionnaire(database, planned);
}

void requireQuestionnaires(const Database& database, const std::string& protocol_sha256, const plan::StudyPlan& plan) {
    Statement changed = database.prepare(
        "SELECT coalesce(json_extract(expanded_json, '$.questionnaires'), '[]') IS NOT "
        "coalesce(json_extract(?2, '$.questionnaires'), '[]') FROM protocol_version WHERE protocol_sha256=?1");
    if (!changed.bind(protocol_sha256, plan.expanded_json).step() || changed.integer(0) == 0) return;
    throw std::runtime_error(
        "a questionnaire's file has changed since this protocol was stored: restore it, or give the protocol a new "
        "version");
}

void insertQuestionnaireRun(const Database& database, const std::string& session_id, std::int64_t segment_id,
                            const session::QuestionnaireRun& run, const FormUtc& utc) {
    const session::Occasion& occasion = run.form.occasion;
    const PlannedQuestionnaire& planned = run.form.planned;
    const char* moment = plan::momentName(planned.moment);
    insertQuestionnaire(database, planned);  // the session's language may be another one than the protocol's first
    std::optional<std::int64_t> condition;
    if (occasion.condition) condition = static_cast<std::int64_t>(*occasion.condition);
    database
        .prepare(
            "INSERT INTO questionnaire_run(session_id, questionnaire_sha256, moment, block_index, trial_id, "
            "condition_id, started_utc, completed_utc) VALUES(?1, ?2, ?3, ?4, (SELECT trial_id FROM trial_plan WHERE "
            "session_id=?1 AND trial_index=?5), (SELECT c.condition_id FROM condition c JOIN session s "
            "USING(protocol_sha256) WHERE s.session_id=?1 AND c.position=?6), coalesce((SELECT "
            "max(t_utc) FROM event WHERE segment_id=?9 AND event='questionnaire_shown' AND "
            "json_extract(payload_json, '$.form')=?10), ?7), ?8)")
        .bind(session_id, digestOf(planned), moment, occasion.block_index, occasion.trial_index, condition, utc.started,
              utc.completed, segment_id, run.form.id())
        .run();
    const std::int64_t run_id = database.lastRowId();
    insertResponses(database, run_id, run);
    insertScores(database, run_id, run);
    const std::string payload = JsonObject()
                                    .text("questionnaire", planned.definition.key)
                                    .text("moment", moment)
                                    .text("form", run.form.id())
                                    .text("answered_by", run.filled.answered_by)
                                    .str();
    insertEvent(database, segment_id,
                {.attempt = {},
                 .t_ns = run.completed_ns,
                 .source = "session",
                 .event = "questionnaire_answered",
                 .payload_json = payload},
                utc.measured ? std::optional(utc.completed) : std::nullopt);
}

std::vector<QuestionnaireRunRow> readQuestionnaireRuns(const Database& database) {
    using Row = QuestionnaireRunRow;
    static const Selection<Row> columns = {
        {"s.participant_id", &Row::participant_id},
        {"p.kind", &Row::kind},
        {"s.ordinal", &Row::session_ordinal},
        {"s.session_id", &Row::session_id},
        {"s.protocol_sha256", &Row::protocol_sha256},
        {"q.key", &Row::questionnaire},
        {"q.version", &Row::version},
        {"q.language", &Row::language},
        {"json_extract(q.definition_json, '$.source.definition')", &Row::definition_text},
        {"json_extract(q.definition_json, '$.source.texts')", &Row::texts_text},
        {"r.moment", &Row::moment},
        {"r.block_index", &Row::block_index},
        {"(SELECT t.block FROM trial_plan t WHERE t.session_id=r.session_id AND t.block_index=r.block_index LIMIT 1)",
         &Row::block},
        {"(SELECT t.trial_index FROM trial_plan t WHERE t.trial_id=r.trial_id)", &Row::trial_index},
        {"c.condition", &Row::condition},
        {"c.position", &Row::condition_position},
        {"r.started_utc", &Row::started_utc},
        {"r.completed_utc", &Row::completed_utc}};
    Statement statement = database.prepare(
        "SELECT " + columns.text() +
        ", r.run_id FROM questionnaire_run r JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
        "JOIN questionnaire q USING(questionnaire_sha256) LEFT JOIN condition c USING(condition_id) "
        "ORDER BY s.participant_id, s.ordinal, r.run_id");
    std::vector<Row> rows;
    while (statement.step()) {
        rows.push_back(columns.read(statement));
        const std::int64_t run_id = statement.integer(columns.size());
        rows.back().responses = readResponses(database, run_id);
        rows.back().scores = readScores(database, run_id);
    }
    return rows;
}

}  // namespace passung::store
