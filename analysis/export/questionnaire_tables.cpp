#include "analysis/export/questionnaire_tables.h"

#include <algorithm>
#include <map>
#include <utility>

#include "analysis/export/cells.h"
#include "analysis/export/counted_forms.h"
#include "analysis/export/shared_columns.h"
#include "analysis/export/trial_tables.h"
#include "study/questionnaire/scoring.h"

namespace passung::exporter {
namespace {

using questionnaire::Definition;
using store::QuestionnaireRunRow;

const store::ViewColumn& ofScores(std::string_view name) { return store::viewColumn(store::StudyView::Scores, name); }

/// Who was asked what, and when: columns that items and scores begin with. Refers to `counted`.
ColumnsOf<QuestionnaireRunRow> runColumns(const CountedRuns& counted) {
    using Row = QuestionnaireRunRow;
    ColumnsOf<Row> columns = participantSessionColumns<Row>();
    append(columns,
           {{ofScores("questionnaire"), "text", &Row::questionnaire},
            {ofScores("version"), "text", &Row::version},
            {ofScores("language"), "text", &Row::language},
            {ofScores("moment"),
             "text",
             &Row::moment,
             {"session_start", "before_block", "after_block", "after_trial", "after_condition", "session_end"}},
            {ofScores("block_index"), "integer", &Row::block_index},
            blockColumn<Row>(),
            {ofScores("trial_index"), "integer", &Row::trial_index},
            {ofScores("condition"), "text", &Row::condition},
            {ofScores("completed_utc"), "time", &Row::completed_utc},
            {ofScores("counted"),
             "0/1",
             [&counted](const Row& run) { return std::binary_search(counted.begin(), counted.end(), &run); },
             {"0", "1"}}});
    return columns;
}

/// The form that a row is of.
template <class Row>
const QuestionnaireRunRow& runOf(const Row& row) {
    return *row.run;
}

/// An item of a filled questionnaire.
struct AnsweredItem {
    const QuestionnaireRunRow* run;
    const store::ItemResponseRow* response;
};

ColumnsOf<store::ItemResponseRow> itemColumns() {
    using store::ItemResponseRow;
    return {{"item", "Its id in the questionnaire's file", "text", &ItemResponseRow::item},
            {"presented_index", "Its place as shown, from 0", "integer", &ItemResponseRow::presented_index},
            {"value", "The answer as given, before any reversal", "number", &ItemResponseRow::value_num},
            {"value_text", "The answer, where it is a text", "text", &ItemResponseRow::value_text, {.typed = true}},
            {"skipped", "1 if it was left out", "0/1", &ItemResponseRow::skipped, {.levels = {"0", "1"}}},
            {"response_time_ms",
             "From showing the item to its last answer; NA where not measured, so always in virtual time",
             "integer",
             &ItemResponseRow::rt_ms,
             {.unit = "ms"}},
            {"changes", "How often the answer was changed", "integer", &ItemResponseRow::changes}};
}

/// A scale of a filled questionnaire; nullptr where this program cannot read the questionnaire.
struct ScoredScale {
    const QuestionnaireRunRow* run;
    const store::ScoreRow* score;
    const Definition* definition;
    const questionnaire::Scale* scale;
};

std::string classOf(const ScoredScale& row) {
    if (row.scale == nullptr || !row.score->value) return {};
    return std::string(questionnaire::classOf(*row.scale, *row.score->value));
}

ColumnsOf<store::ScoreRow> scoreCounts() {
    using store::ScoreRow;
    return {{ofScores("n_items"), "integer", &ScoreRow::n_items},
            {ofScores("n_missing"), "integer", &ScoreRow::n_missing},
            {ofScores("scoring_version"), "integer", &ScoreRow::scoring_version}};
}

ColumnsOf<ScoredScale> scoreColumns(const CountedRuns& counted) {
    ColumnsOf<ScoredScale> columns;
    append(columns, runColumns(counted), runOf<ScoredScale>);
    append(columns, {{ofScores("scale"), "text", [](const ScoredScale& row) { return row.score->scale; }},
                     {"scale_label", "What it measures", "text",
                      [](const ScoredScale& row) { return row.scale != nullptr ? row.scale->label : kMissing; }},
                     {ofScores("score"), "number", [](const ScoredScale& row) { return row.score->value; }},
                     {"class", "Named range that the score is in; NA without classes", "text", classOf}});
    append(columns, scoreCounts(), [](const ScoredScale& row) -> const store::ScoreRow& { return *row.score; });
    append(columns, {{"scale_formula", "How the score is computed", "text", [](const ScoredScale& row) {
                          return row.scale != nullptr ? questionnaire::formulaText(*row.definition, *row.scale)
                                                      : kMissing;
                      }}});
    append(columns, ColumnsOf<QuestionnaireRunRow>{protocolColumn<QuestionnaireRunRow>(kInFolder)}, runOf<ScoredScale>);
    return columns;
}

/// A column of the wide table; sorts by questionnaire, then as the session goes.
struct WideColumn {
    std::string questionnaire, moment;
    std::optional<std::int64_t> block_index, condition_position;
    std::optional<std::string> block, condition;
    std::string scale;
    friend auto operator<=>(const WideColumn&, const WideColumn&) = default;
};

WideColumn wideColumn(const QuestionnaireRunRow& run, const std::string& scale) {
    return {run.questionnaire, run.moment, run.block_index, run.condition_position, run.block, run.condition, scale};
}

/// "ssq.total.session_end", "nasa_tlx_raw.workload.after_block.main", with the condition's part at the end.
std::string columnName(const WideColumn& column) {
    std::string name = column.questionnaire + "." + column.scale + "." + column.moment;
    if (column.block) name += "." + *column.block;
    return column.condition ? name + "." + columnPart(*column.condition) : name;
}

/// A row of the wide table.
struct PersonSession {
    std::string participant_id, kind, protocol_sha256;
    std::int64_t session_ordinal = 1;
    std::string group;
    friend auto operator<=>(const PersonSession&, const PersonSession&) = default;
};

/// With the scores of all forms of an occasion.
using ScoredSession = std::pair<const PersonSession, std::map<WideColumn, std::vector<double>>>;

/// Refers to `study`.
ColumnsOf<PersonSession> personSessionColumns(const StudyData& study) {
    ColumnsOf<PersonSession> columns = whoColumns<PersonSession>();
    append(columns,
           {sequenceColumn<PersonSession>(study), sessionColumn<PersonSession>(), protocolColumn<PersonSession>()});
    return columns;
}

/// The mean of an occasion's scores. `run`: one of its forms.
ColumnOf<ScoredSession> meanScoreColumn(std::string name, const WideColumn& column, const QuestionnaireRunRow& run,
                                        Definitions& definitions) {
    const questionnaire::Scale* scale = definitions.scale(run, column.scale);
    const Definition* definition = definitions.of(run);
    return {std::move(name),
            scale != nullptr ? definition->title + ": " + scale->label : column.scale,
            "number",
            [column](const ScoredSession& session) {
                const auto found = session.second.find(column);
                return found == session.second.end() ? kMissing : cell(meanOf(found->second));
            },
            {.formula = scale != nullptr ? "mean over the forms of this occasion of: " +
                                               questionnaire::formulaText(*definition, *scale)
                                         : "",
             .formula_version = definition != nullptr ? definition->scoring_version : 1}};
}

}  // namespace

Table makeQuestionnaireItems(const StudyData& study) {
    const CountedRuns counted = countedRuns(study);
    ColumnsOf<AnsweredItem> columns;
    append(columns, runColumns(counted), runOf<AnsweredItem>);
    append(columns, itemColumns(),
           [](const AnsweredItem& row) -> const store::ItemResponseRow& { return *row.response; });
    append(columns, ColumnsOf<QuestionnaireRunRow>{protocolColumn<QuestionnaireRunRow>(kInFolder)},
           runOf<AnsweredItem>);
    std::vector<AnsweredItem> rows;
    for (const QuestionnaireRunRow& run : study.questionnaires)
        for (const store::ItemResponseRow& response : run.responses) rows.push_back({&run, &response});
    return makeTable("questionnaire_items.csv", "One row per item of every filled questionnaire.", columns, rows);
}

Table makeQuestionnaireScores(const StudyData& study) {
    const CountedRuns counted = countedRuns(study);
    Definitions definitions;
    std::vector<ScoredScale> rows;
    for (const QuestionnaireRunRow& run : study.questionnaires)
        for (const store::ScoreRow& score : run.scores)
            rows.push_back({&run, &score, definitions.of(run), definitions.scale(run, score.scale)});
    return makeTable("questionnaire_scores.csv", "One row per scale of every filled questionnaire.",
                     scoreColumns(counted), rows);
}

Table makeScoresWide(const StudyData& study) {
    std::map<WideColumn, const QuestionnaireRunRow*> occasions;
    std::map<PersonSession, std::map<WideColumn, std::vector<double>>> people;
    for (const QuestionnaireRunRow* run : countedRuns(study)) {
        auto& scores = people[{run->participant_id, run->kind, run->protocol_sha256, run->session_ordinal,
                               groupOf(study, run->participant_id)}];
        for (const store::ScoreRow& score : run->scores) {
            const WideColumn column = wideColumn(*run, score.scale);
            occasions.emplace(column, run);
            if (score.value) scores[column].push_back(*score.value);
        }
    }
    ColumnsOf<ScoredSession> columns;
    append(columns, personSessionColumns(study),
           [](const ScoredSession& session) -> const PersonSession& { return session.first; });
    Definitions definitions;
    for (const auto& [column, run] : occasions) {
        std::string name = columnName(column);
        const auto is_taken = [&] {
            return std::any_of(columns.begin(), columns.end(),
                               [&](const auto& other) { return other.description.name == name; });
        };
        while (is_taken()) name += '_';
        columns.push_back(meanScoreColumn(name, column, *run, definitions));
    }
    return makeTable(
        "scores_wide.csv",
        "One row per participant, protocol and session, one column per scale and occasion: mean of the counted forms' "
        "scores.",
        columns, people);
}

}  // namespace passung::exporter
