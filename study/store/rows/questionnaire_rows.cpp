#include "study/store/rows/questionnaire_rows.h"

#include <stdexcept>

#include "core/base/digest.h"
#include "core/base/json.h"
#include "study/store/rows/event_rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {
namespace {

using protocol::PlannedQuestionnaire;

/// Everything that decides what was shown and how it was scored.
std::string definitionJson(const PlannedQuestionnaire& planned) {
    return JsonObject().text("language", planned.language).json("source", planned.source_json).str();
}

std::string digestOf(const PlannedQuestionnaire& planned) { return sha256Hex(definitionJson(planned)); }

void insertResponses(const Database& database, std::int64_t run_id, const session::QuestionnaireRun& run) {
    Statement insert = database.prepare("INSERT INTO item_response VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
    const auto& items = run.form.planned.definition.items;
    for (std::size_t shown = 0; shown < run.form.order.size(); ++shown) {
        const std::size_t i = run.form.order[shown];
        const session::ItemAnswer& given = run.filled.answers[i];
        const auto text = given.answer.text.empty() ? std::nullopt : std::optional(given.answer.text);
        insert
            .bind(run_id, items[i].id, static_cast<std::int64_t>(shown), given.answer.number, text,
                  given.answer.missing(), given.response_ms, given.changes)
            .run();
    }
}

void insertScores(const Database& database, std::int64_t run_id, const session::QuestionnaireRun& run) {
    Statement insert = database.prepare("INSERT INTO score VALUES(?, ?, ?, ?, ?, ?)");
    const auto& definition = run.form.planned.definition;
    for (std::size_t i = 0; i < run.scores.size(); ++i)
        insert
            .bind(run_id, definition.scales[i].name, run.scores[i].value,
                  static_cast<std::int64_t>(run.scores[i].items), static_cast<std::int64_t>(run.scores[i].missing),
                  definition.scoring_version)
            .run();
}

/// Unless it is there.
void insertQuestionnaire(const Database& database, const PlannedQuestionnaire& planned) {
    const std::string json = definitionJson(planned), sha256 = sha256Hex(json);
    const auto& definition = planned.definition;
    database.prepare("INSERT OR IGNORE INTO questionnaire VALUES(?, ?, ?, ?, ?, ?)")
        .bind(sha256, definition.key, definition.version, definition.language, definition.licence, json)
        .run();
}

template <class Row, class Read>
std::vector<Row> readOf(const Database& database, std::string_view sql, std::int64_t run_id, Read read) {
    Statement statement = database.prepare(sql);
    statement.bind(run_id);
    std::vector<Row> rows;
    while (statement.step()) rows.push_back(read(statement));
    return rows;
}

std::vector<ItemResponseRow> readResponses(const Database& database, std::int64_t run_id) {
    return readOf<ItemResponseRow>(
        database,
        "SELECT item, presented_index, value_num, value_text, skipped, rt_ms, changes FROM item_response "
        "WHERE run_id=? ORDER BY presented_index",
        run_id, [](const Statement& row) {
            ItemResponseRow item{row.text(0),         row.integer(1),         row.optionalReal(2), {},
                                 row.integer(4) != 0, row.optionalInteger(5), row.integer(6)};
            if (!row.isNull(3)) item.value_text = row.text(3);
            return item;
        });
}

std::vector<ScoreRow> readScores(const Database& database, std::int64_t run_id) {
    return readOf<ScoreRow>(
        database, "SELECT scale, value, n_items, n_missing, scoring_version FROM score WHERE run_id=? ORDER BY scale",
        run_id, [](const Statement& row) {
            return ScoreRow{row.text(0), row.optionalReal(1), row.integer(2), row.integer(3), row.integer(4)};
        });
}

}  // namespace

void insertQuestionnaires(const Database& database, const protocol::StudyPlan& plan) {
    for (const PlannedQuestionnaire& planned : plan.questionnaires) insertQuestionnaire(database, planned);
}

void requireQuestionnaires(const Database& database, const std::string& protocol_sha256,
                           const protocol::StudyPlan& plan) {
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
    const char* moment = protocol::momentName(planned.moment);
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
    Statement statement = database.prepare(
        "SELECT r.run_id, s.participant_id, p.kind, s.ordinal, s.session_id, s.protocol_sha256, q.key, q.version, "
        "q.language, json_extract(q.definition_json, '$.source.definition'), "
        "json_extract(q.definition_json, '$.source.texts'), r.moment, r.block_index, "
        "(SELECT t.block FROM trial_plan t WHERE t.session_id=r.session_id AND t.block_index=r.block_index LIMIT 1), "
        "(SELECT t.trial_index FROM trial_plan t WHERE t.trial_id=r.trial_id), c.condition, c.position, "
        "r.started_utc, r.completed_utc "
        "FROM questionnaire_run r JOIN session s USING(session_id) JOIN participant p USING(participant_id) "
        "JOIN questionnaire q USING(questionnaire_sha256) LEFT JOIN condition c USING(condition_id) "
        "ORDER BY s.participant_id, s.ordinal, r.run_id");
    const auto text = [&](int column) {
        return statement.isNull(column) ? std::nullopt : std::optional(statement.text(column));
    };
    std::vector<QuestionnaireRunRow> rows;
    while (statement.step()) {
        const std::int64_t run_id = statement.integer(0);
        rows.push_back({statement.text(1),
                        statement.text(2),
                        statement.integer(3),
                        statement.text(4),
                        statement.text(5),
                        statement.text(6),
                        statement.text(7),
                        statement.text(8),
                        statement.text(9),
                        text(10),
                        statement.text(11),
                        statement.optionalInteger(12),
                        text(13),
                        statement.optionalInteger(14),
                        text(15),
                        statement.optionalInteger(16),
                        statement.text(17),
                        text(18),
                        readResponses(database, run_id),
                        readScores(database, run_id)});
    }
    return rows;
}

}  // namespace passung::store
