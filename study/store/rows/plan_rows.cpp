#include "study/store/rows/plan_rows.h"

#include <map>

#include "study/store/rows/attempt_rows.h"
#include "study/store/schema/named_columns.h"

namespace passung::store {
namespace {

constexpr const char* kByProtocol = " ORDER BY p.name, p.version, p.protocol_sha256";

std::vector<std::string> readTexts(const Database& database, const std::string& json) {
    std::vector<std::string> texts;
    Statement each = database.prepare("SELECT value FROM json_each(?)");
    each.bind(json);
    while (each.step()) texts.push_back(each.text(0));
    return texts;
}

std::vector<plan::Contrast> readContrasts(const Database& database, const std::string& json) {
    std::vector<plan::Contrast> contrasts;
    Statement each = database.prepare(
        "SELECT json_extract(value, '$.factor'), json_extract(value, '$.level'), json_extract(value, '$.against') "
        "FROM json_each(?)");
    each.bind(json);
    while (each.step()) contrasts.push_back({each.text(0), each.text(1), each.text(2)});
    return contrasts;
}

}  // namespace

std::vector<std::string> readMainBlocks(const Database& database, const std::string& expanded_json) {
    std::vector<std::string> names;
    Statement block = database.prepare(
        "SELECT json_extract(b.value, '$.name') FROM json_each(?1, '$.blocks') b "
        "WHERE json_extract(b.value, '$.phase')='main' AND json_extract(b.value, '$.name') NOT IN "
        "(SELECT json_extract(s.value, '$.block') FROM json_each(?1, '$.staircases') s) ORDER BY b.key");
    block.bind(expanded_json);
    while (block.step()) names.push_back(block.text(0));
    return names;
}

std::vector<ConditionRow> readConditions(const Database& database) {
    std::vector<ConditionRow> rows;
    std::map<std::pair<std::string, std::string>, std::size_t> places;  // protocol, condition
    Statement row = database.prepare(
        std::string("SELECT c.protocol_sha256, c.condition, c.levels_json FROM condition c "
                    "JOIN protocol_version p USING(protocol_sha256) WHERE c.position < "
                    "coalesce(json_extract(p.expanded_json, '$.planned_conditions'), c.position + 1)") +
        kByProtocol + ", c.position");
    while (row.step()) {
        places[{row.text(0), row.text(1)}] = rows.size();
        rows.push_back({row.text(0), row.text(1), readLevels(database, row.text(2))});
    }
    Statement facts = database.prepare(
        "SELECT p.protocol_sha256, json_extract(c.value, '$.condition'), "
        "coalesce(json_extract(c.value, '$.params.task.type'), ''), "
        "json_extract(c.value, '$.params.task.timeout_s'), "
        "coalesce(json_extract(c.value, '$.params.timed_by'), 'program'), "
        "coalesce(json_extract(c.value, '$.params.secondary.stimulus'), 'none') "
        "FROM protocol_version p, json_each(p.expanded_json, '$.conditions') c");
    while (facts.step()) {
        const auto place = places.find({facts.text(0), facts.text(1)});
        if (place == places.end()) continue;
        ConditionRow& condition = rows[place->second];
        condition.task_type = facts.text(2);
        condition.timeout_s = facts.optionalReal(3);
        condition.timed_by = facts.text(4);
        condition.stimulus = facts.text(5);
    }
    return rows;
}

std::vector<PlannedCellRow> readPlannedCells(const Database& database) {
    using Row = PlannedCellRow;
    const Selection<Row> columns = {{"s.session_id", &Row::session_id},   {"s.participant_id", &Row::participant_id},
                                    {"s.ordinal", &Row::session_ordinal}, {"s.protocol_sha256", &Row::protocol_sha256},
                                    {"t.block_index", &Row::block_index}, {"t.block", &Row::block},
                                    {"c.condition", &Row::condition},     {"count(*)", &Row::trials}};
    return columns.all(database,
                       "FROM trial_plan t JOIN session s USING(session_id) JOIN condition c USING(condition_id) "
                       "WHERE t.phase='main' GROUP BY s.session_id, t.block_index, c.condition_id "
                       "ORDER BY s.participant_id, s.ordinal, t.block_index, c.position");
}

std::vector<AnalysisRow> readAnalyses(const Database& database) {
    using Row = AnalysisRow;
    // What came later stands in a plan only where its protocol has it.
    const Selection<Row> columns = {
        {"p.protocol_sha256", &Row::protocol_sha256},
        {"a.key + 1", &Row::number},
        {"json_extract(a.value, '$.outcome')", &Row::outcome},
        {"json_extract(a.value, '$.staircase')", &Row::staircase},
        {"json_extract(a.value, '$.block')", &Row::block},
        {"json_extract(a.value, '$.factors')",
         [&database](const Statement& row, int column, Row& to) {
             to.factors = readTexts(database, row.text(column));
         }},
        {"json_extract(a.value, '$.test')", &Row::test},
        {"coalesce(json_extract(a.value, '$.role'), '')", &Row::role},
        {"coalesce(json_extract(a.value, '$.transform'), '')", &Row::transform},
        {"coalesce(json_extract(a.value, '$.family'), '')", &Row::family},
        {"coalesce(json_extract(a.value, '$.covariates'), '[]')",
         [&database](const Statement& row, int column, Row& to) {
             to.covariates = readTexts(database, row.text(column));
         }},
        {"coalesce(json_extract(a.value, '$.contrasts'), '[]')",
         [&database](const Statement& row, int column, Row& to) {
             to.contrasts = readContrasts(database, row.text(column));
         }},
        {"json_extract(a.value, '$.equivalence_bounds[0]')",
         [](const Statement& row, int column, Row& to) {
             if (!row.isNull(column)) to.equivalence_bounds.emplace(row.real(column), 0.0);
         }},
        {"json_extract(a.value, '$.equivalence_bounds[1]')", [](const Statement& row, int column, Row& to) {
             if (to.equivalence_bounds) to.equivalence_bounds->second = row.real(column);
         }}};
    return columns.all(database, std::string("FROM protocol_version p, json_each(p.expanded_json, '$.analyses') a") +
                                     kByProtocol + ", a.key");
}

std::vector<DataRuleRow> readDataRules(const Database& database) {
    using Row = DataRuleRow;
    const Selection<Row> columns = {
        {"p.protocol_sha256", &Row::protocol_sha256},
        {"r.key + 1", &Row::number},
        {"json_extract(r.value, '$.data')='participants'",
         [](const Statement& row, int column, Row& to) { to.rule.of_participants = row.integer(column) != 0; }},
        {"json_extract(r.value, '$.value')",
         [](const Statement& row, int column, Row& to) { to.rule.value = row.text(column); }},
        {"json_extract(r.value, '$.below')",
         [](const Statement& row, int column, Row& to) { readValue(row, column, to.rule.below); }},
        {"json_extract(r.value, '$.above')",
         [](const Statement& row, int column, Row& to) { readValue(row, column, to.rule.above); }},
        {"coalesce(json_extract(r.value, '$.reason'), '')",
         [](const Statement& row, int column, Row& to) { to.rule.reason = row.text(column); }}};
    return columns.all(database, std::string("FROM protocol_version p, json_each(p.expanded_json, '$.data_rules') r") +
                                     kByProtocol + ", r.key");
}

std::vector<NamedFileRow> readNamedFiles(const Database& database) {
    const Selection<NamedFileRow> columns = {{"f.sha", &NamedFileRow::protocol_sha256},
                                             {"f.kind", &NamedFileRow::kind},
                                             {"f.name", &NamedFileRow::name},
                                             {"f.text", &NamedFileRow::text},
                                             {"f.sha256", &NamedFileRow::sha256}};
    Statement row = database.prepare(
        "WITH planned AS (SELECT p.protocol_sha256 sha, q.value planned FROM protocol_version p, "
        "json_each(p.expanded_json, '$.questionnaires') q WHERE q.type='object'), file(sha, kind, name, text, sha256) "
        "AS ("
        "SELECT protocol_sha256, 'mesh', mesh, NULL, sha256 FROM mesh_file "
        "UNION SELECT protocol_sha256, 'picture', picture, NULL, sha256 FROM picture_file "
        "UNION SELECT sha, 'questionnaire', json_extract(planned, '$.file'), "
        "json_extract(planned, '$.source.definition'), NULL FROM planned "
        "UNION SELECT sha, 'questionnaire_texts', json_extract(planned, '$.texts'), "
        "json_extract(planned, '$.source.texts'), NULL FROM planned WHERE json_extract(planned, '$.texts')<>'') "
        "SELECT " +
        columns.text() +
        " FROM file f "
        "JOIN protocol_version p ON p.protocol_sha256=f.sha ORDER BY p.name, p.version, f.sha, f.kind, f.name");
    return columns.allOf(row);
}

std::vector<QuestionnaireRow> readQuestionnaires(const Database& database) {
    using Row = QuestionnaireRow;
    const Selection<Row> columns = {{"key", &Row::questionnaire},
                                    {"version", &Row::version},
                                    {"language", &Row::language},
                                    {"json_extract(definition_json, '$.source.definition')", &Row::definition_text},
                                    {"json_extract(definition_json, '$.source.texts')", &Row::texts_text}};
    return columns.all(database, "FROM questionnaire ORDER BY key, version, language, questionnaire_sha256");
}

}  // namespace passung::store
