#include "analysis/export/questionnaire_tables.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "analysis/export/trial_tables.h"
#include "study/protocol/participant.h"
#include "study/protocol/questionnaire_reader.h"
#include "study/protocol/questionnaire_texts.h"
#include "study/questionnaire/cronbach_alpha.h"
#include "study/questionnaire/scoring.h"

namespace passung::exporter {
namespace {

using questionnaire::Definition;
using store::QuestionnaireRunRow;

/// The instruments of the runs, each read once.
class Definitions {
public:
    /// nullptr where this program cannot read the stored text.
    const Definition* of(const QuestionnaireRunRow& run) {
        const std::tuple key(run.definition_text, run.texts_text, run.language);
        auto found = known_.find(key);
        if (found == known_.end()) {
            auto definition = protocol::readQuestionnaire(run.definition_text, run.questionnaire, run.language);
            if (definition && run.texts_text)
                definition = protocol::withTexts(*std::move(definition), *run.texts_text, run.questionnaire);
            found = known_.emplace(key, definition ? std::optional(*std::move(definition)) : std::nullopt).first;
        }
        return found->second ? &*found->second : nullptr;
    }

    const questionnaire::Scale* scale(const QuestionnaireRunRow& run, const std::string& name) {
        const Definition* definition = of(run);
        const auto index = definition != nullptr ? questionnaire::scaleNamed(*definition, name) : std::nullopt;
        return index ? &definition->scales[*index] : nullptr;
    }

private:
    std::map<std::tuple<std::string, std::optional<std::string>, std::string>, std::optional<Definition>> known_;
};

/// Forms that enter means, in the order of the study's rows.
using CountedRuns = std::vector<const QuestionnaireRunRow*>;

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

/// Of the counted sessions the newest form of each occasion: who goes back to a trial or block is asked again.
CountedRuns countedRuns(const StudyData& study) {
    const std::set<std::string> counted = countedSessions(study);
    using Occasion = std::tuple<std::string, std::string, std::string, std::optional<std::int64_t>,
                                std::optional<std::int64_t>, std::optional<std::string>>;
    std::map<Occasion, const QuestionnaireRunRow*> newest;  // rows come as they were filled in
    for (const QuestionnaireRunRow& run : study.questionnaires)
        if (counted.count(run.session_id) != 0)
            newest[{run.session_id, run.questionnaire, run.moment, run.block_index, run.trial_index, run.condition}] =
                &run;
    CountedRuns runs;
    for (const auto& [occasion, run] : newest) runs.push_back(run);
    std::sort(runs.begin(), runs.end());
    return runs;
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

/// The aligned answers to a scale's items; nothing if one is missing.
std::optional<std::vector<double>> alignedAnswers(const Definition& definition, const questionnaire::Scale& scale,
                                                  const QuestionnaireRunRow& run) {
    std::vector<double> values;
    for (const std::size_t i : scale.items) {
        const questionnaire::Item& item = definition.items[i];
        const auto found = std::find_if(run.responses.begin(), run.responses.end(),
                                        [&](const auto& response) { return response.item == item.id; });
        if (found == run.responses.end() || !found->value_num) return std::nullopt;
        values.push_back(item.reversed ? item.response.low + item.response.high - *found->value_num
                                       : *found->value_num);
    }
    return values;
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
        "One row per participant and protocol, one column per scale and occasion: mean of the counted forms' "
        "scores.",
        {{"participant_id", "Code of the participant", "", "text", "", 1, {}},
         {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
         {"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}}},
        {}};
    using Person = std::tuple<std::string, std::string, std::string>;
    std::map<WideColumn, const QuestionnaireRunRow*> columns;
    std::map<Person, std::map<WideColumn, std::vector<double>>> people;
    for (const QuestionnaireRunRow* run : countedRuns(study)) {
        auto& scores = people[{run->participant_id, run->kind, run->protocol_sha256}];
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
        const auto& [participant, kind, protocol] = person;
        std::vector<std::string> row = {participant, kind, protocol};
        for (const auto& [column, run] : columns) {
            const auto found = scores.find(column);
            row.push_back(found == scores.end() ? kMissing : cell(meanOf(found->second)));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table makeReliability(const StudyData& study) {
    Table table{
        "questionnaire_reliability.csv",
        "One row per scale of at least two items and moment: how well the items agree.",
        {{"kind", "Real people, pilots or simulated participants", "", "text", "", 1, protocol::participantKindNames()},
         {"questionnaire", "Key of the questionnaire", "", "text", "", 1, {}},
         {"version", "Version of its items and texts", "", "text", "", 1, {}},
         {"moment", "When it was asked", "", "text", "", 1, {}},
         {"scale", "Name of the scale", "", "text", "", 1, {}},
         {"n_forms", "Counted forms without a missing item in the scale", "", "integer", "", 1, {}},
         {"n_items", "Items of the scale", "", "integer", "", 1, {}},
         {"cronbach_alpha",
          "Internal consistency; forms of one person count as if they were independent",
          "",
          "number",
          "k/(k-1) (1 - sum of the items' variances / variance of their sum), k items",
          1,
          {}}},
        {}};
    using Key = std::tuple<std::string, std::string, std::string, std::string, std::string>;
    std::map<Key, std::vector<std::vector<double>>> answers;
    std::map<Key, std::size_t> items;
    Definitions definitions;
    for (const QuestionnaireRunRow* run : countedRuns(study)) {
        const Definition* definition = definitions.of(*run);
        if (definition == nullptr) continue;
        for (const questionnaire::Scale& scale : definition->scales) {
            using questionnaire::Formula;
            const bool averages = scale.formula == Formula::Mean || scale.formula == Formula::Sum;
            if (scale.items.size() < 2 || !averages) continue;
            const Key key(run->kind, run->questionnaire, run->version, run->moment, scale.name);
            items[key] = scale.items.size();
            auto& rows = answers[key];
            if (auto row = alignedAnswers(*definition, scale, *run)) rows.push_back(*std::move(row));
        }
    }
    for (const auto& [key, rows] : answers) {
        const auto& [kind, name, version, moment, scale] = key;
        table.rows.push_back({kind, name, version, moment, scale, cell(static_cast<std::int64_t>(rows.size())),
                              cell(static_cast<std::int64_t>(items[key])), cell(questionnaire::cronbachAlpha(rows))});
    }
    return table;
}

}  // namespace passung::exporter
