#include "analysis/export/questionnaire_tables.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "analysis/export/cells.h"
#include "analysis/export/counted_forms.h"
#include "analysis/export/trial_tables.h"
#include "study/plan/participant.h"
#include "study/questionnaire/scoring.h"

namespace passung::exporter {
namespace {

using questionnaire::Definition;
using store::QuestionnaireRunRow;

/// Who was asked what, and when: columns that items and scores begin with.
std::vector<Column> runColumns() {
    return {
        {"participant_id", "Code of the participant", "", "text", "", 1, {}},
        {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
        {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
        {"questionnaire", "Key of the questionnaire", "", "text", "", 1, {}},
        {"version", "Version of its items and texts", "", "text", "", 1, {}},
        {"language", "Language in which it was shown", "", "text", "", 1, {}},
        {"moment",
         "When it was asked",
         "",
         "text",
         "",
         1,
         {"session_start", "before_block", "after_block", "after_trial", "after_condition", "session_end"}},
        {"block_index", "Number of the block, from 0; NA at the session's start and end", "", "integer", "", 1, {}},
        {"block", "Name of the block", "", "text", "", 1, {}},
        {"trial_index", "The trial that it is about, if it is about one", "", "integer", "", 1, {}},
        {"condition",
         "The condition that it is about, if it is about one; its levels: see cells_long.csv",
         "",
         "text",
         "",
         1,
         {}},
        {"completed_utc", "When the last answer was given", "", "time", "", 1, {}},
        {"counted",
         "1 if means and reliability count this form: of a counted session (see sessions.csv) the newest one about its "
         "occasion",
         "",
         "0/1",
         "",
         1,
         {"0", "1"}},
    };
}

std::vector<std::string> runCells(const QuestionnaireRunRow& run, const CountedRuns& counted) {
    return {run.participant_id,
            run.kind,
            cell(run.session_ordinal),
            run.questionnaire,
            run.version,
            run.language,
            run.moment,
            cell(run.block_index),
            cell(run.block),
            cell(run.trial_index),
            cell(run.condition),
            cell(run.completed_utc),
            cell(std::binary_search(counted.begin(), counted.end(), &run))};
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

}  // namespace

Table makeQuestionnaireItems(const StudyData& study) {
    Table table{"questionnaire_items.csv", "One row per item of every filled questionnaire.", runColumns(), {}};
    const std::vector<Column> more = {
        {"item", "Its id in the questionnaire's file", "", "text", "", 1, {}},
        {"presented_index", "Its place as shown, from 0", "", "integer", "", 1, {}},
        {"value", "The answer as given, before any reversal", "", "number", "", 1, {}},
        {"value_text", "The answer, where it is a text", "", "text", "", 1, {}},
        {"skipped", "1 if it was left out", "", "0/1", "", 1, {"0", "1"}},
        {"response_time_ms",
         "From showing the item to its last answer; NA where not measured, so always in virtual time",
         "ms",
         "integer",
         "",
         1,
         {}},
        {"changes", "How often the answer was changed", "", "integer", "", 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
    };
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    const CountedRuns counted = countedRuns(study);
    for (const QuestionnaireRunRow& run : study.questionnaires) {
        for (const store::ItemResponseRow& item : run.responses) {
            std::vector<std::string> row = runCells(run, counted);
            row.insert(row.end(), {item.item, cell(item.presented_index), cell(item.value_num), cell(item.value_text),
                                   cell(item.skipped), cell(item.rt_ms), cell(item.changes), run.protocol_sha256});
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

Table makeQuestionnaireScores(const StudyData& study) {
    Table table{"questionnaire_scores.csv", "One row per scale of every filled questionnaire.", runColumns(), {}};
    const std::vector<Column> more = {
        {"scale", "Name of the scale", "", "text", "", 1, {}},
        {"scale_label", "What it measures", "", "text", "", 1, {}},
        {"score", "NA: too many answers are missing", "", "number", "see scale_formula", 1, {}},
        {"class", "Named range that the score is in; NA without classes", "", "text", "", 1, {}},
        {"n_items", "Answers that enter; one that enters by two scales counts twice", "", "integer", "", 1, {}},
        {"n_missing", "Of them missing", "", "integer", "", 1, {}},
        {"scoring_version", "Counts changes of the formulas", "", "integer", "", 1, {}},
        {"scale_formula", "How the score is computed", "", "text", "", 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
    };
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    Definitions definitions;
    const CountedRuns counted = countedRuns(study);
    for (const QuestionnaireRunRow& run : study.questionnaires) {
        for (const store::ScoreRow& score : run.scores) {
            const questionnaire::Scale* scale = definitions.scale(run, score.scale);
            const std::string label(scale != nullptr && score.value ? questionnaire::classOf(*scale, *score.value)
                                                                    : "");
            std::vector<std::string> row = runCells(run, counted);
            row.insert(row.end(),
                       {score.scale, scale != nullptr ? scale->label : kMissing, cell(score.value),
                        label.empty() ? kMissing : label, cell(score.n_items), cell(score.n_missing),
                        cell(score.scoring_version),
                        scale != nullptr ? questionnaire::formulaText(*definitions.of(run), *scale) : kMissing,
                        run.protocol_sha256});
            table.rows.push_back(std::move(row));
        }
    }
    return table;
}

Table makeScoresWide(const StudyData& study) {
    Table table{
        "scores_wide.csv",
        "One row per participant, protocol and session, one column per scale and occasion: mean of the counted forms' "
        "scores.",
        whoColumns(),
        {}};
    for (const Column& column :
         {sequenceColumn(), Column{"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
          Column{"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}}})
        table.columns.push_back(column);
    using Person = std::tuple<std::string, std::string, std::string, std::int64_t>;
    std::map<WideColumn, const QuestionnaireRunRow*> columns;
    std::map<Person, std::map<WideColumn, std::vector<double>>> people;
    for (const QuestionnaireRunRow* run : countedRuns(study)) {
        auto& scores = people[{run->participant_id, run->kind, run->protocol_sha256, run->session_ordinal}];
        for (const store::ScoreRow& score : run->scores) {
            const WideColumn column = wideColumn(*run, score.scale);
            columns.emplace(column, run);
            if (score.value) scores[column].push_back(*score.value);
        }
    }
    Definitions definitions;
    for (const auto& [column, run] : columns) {
        std::string name = columnName(column);
        const auto is_taken = [&] {
            return std::any_of(table.columns.begin(), table.columns.end(),
                               [&](const Column& other) { return other.name == name; });
        };
        while (is_taken()) name += '_';
        const questionnaire::Scale* scale = definitions.scale(*run, column.scale);
        const Definition* definition = definitions.of(*run);
        table.columns.push_back({name,
                                 scale != nullptr ? definition->title + ": " + scale->label : column.scale,
                                 "",
                                 "number",
                                 scale != nullptr ? "mean over the forms of this occasion of: " +
                                                        questionnaire::formulaText(*definition, *scale)
                                                  : "",
                                 definition != nullptr ? definition->scoring_version : 1,
                                 {}});
    }
    for (const auto& [person, scores] : people) {
        const auto& [participant, kind, protocol, session] = person;
        std::vector<std::string> row = {
            participant, kind, groupOf(study, participant), sequenceOf(study, participant), cell(session), protocol};
        for (const auto& [column, run] : columns) {
            const auto found = scores.find(column);
            row.push_back(found == scores.end() ? kMissing : cell(meanOf(found->second)));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace passung::exporter
