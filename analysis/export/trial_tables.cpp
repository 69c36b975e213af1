#include "analysis/export/trial_tables.h"

#include <algorithm>
#include <iterator>

#include "study/protocol/participant.h"

namespace passung::exporter {
namespace {

constexpr const char* kCounted =
    "over the counted session's valid attempts of the main phase that ended in success, failure or timeout";

std::vector<Column> whoColumns() {
    return {
        {"participant_id", "Code of the participant", "", "text", "", 1, {}},
        {"kind", "Real person, pilot or simulated participant", "", "text", "", 1, protocol::participantKindNames()},
        {"group", "Group of the between-subjects factors; all if there is none", "", "text", "", 1, {}}};
}

/// Columns of trials.csv before the factors.
std::vector<Column> leadingColumns() {
    std::vector<Column> columns = whoColumns();
    const std::vector<Column> more = {
        {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
        {"station", "Place where the session ran", "", "text", "", 1, {}},
        {"device", "Haptic device of the attempt", "", "text", "", 1, {}},
        {"block_index", "Number of the block, from 0", "", "integer", "", 1, {}},
        {"block", "Name of the block", "", "text", "", 1, {}},
        {"phase", "Phase of the block", "", "text", "", 1, {"practice", "main", "catch", "adaptive"}},
        {"trial_index", "Number of the trial in the session, from 0", "", "integer", "", 1, {}},
        {"trial_in_block", "Number of the trial in the block, from 0", "", "integer", "", 1, {}},
        {"repetition", "Pass through the block's conditions, from 1", "", "integer", "", 1, {}},
        {"attempt_no", "Number of the attempt at this trial, from 1", "", "integer", "", 1, {}},
        {"condition", "Name of the condition: its levels joined by /", "", "text", "", 1, {}},
    };
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

/// Columns of trials.csv between the factors and the measures.
std::vector<Column> resultColumns() {
    return {
        {"start_s", "Start of the attempt, from the session's start", "s", "number", "", 1, {}},
        {"duration_s", "From the start of the attempt to its end", "s", "number", "end - start", 1, {}},
        {"outcome",
         "How the attempt ended; crashed: the program ended first; running: it has not ended yet",
         "",
         "text",
         "",
         1,
         {"success", "failure", "timeout", "aborted", "crashed", "running"}},
        {"valid", "1 if the attempt may be analysed", "", "0/1", "", 1, {"0", "1"}},
        {"invalid_reason", "Why the attempt may not be analysed", "", "text", "", 1, {}},
    };
}

/// Columns of trials.csv after the measures.
std::vector<Column> closingColumns() {
    return {
        {"feedback_given",
         "What the participant was given to feel, see and hear of contact, joined by +: kinesthetic (force), visual, "
         "vibrotactile, audio, masking_noise; none",
         "",
         "text",
         "",
         1,
         {}},
        {"timed_by",
         "Who said when the trial began and ended; simulated participants have their part of the experimenter "
         "simulated "
         "too",
         "",
         "text",
         "",
         1,
         {"program", "experimenter", "clock"}},
        {"n_ticks", "Ticks that the haptic loop computed", "", "integer", "", 1, {}},
        {"overruns",
         "Cycles that were missed because an earlier one took too long; 0 in virtual time",
         "",
         "integer",
         "",
         1,
         {}},
        {"dropped_samples", "Ticks that were computed but could not be recorded", "", "integer", "", 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text, see protocol/", "", "text", "", 1, {}},
        {"app_version", "Version of the program", "", "text", "", 1, {}},
    };
}

void append(std::vector<Column>& columns, const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

void appendFactors(std::vector<Column>& columns, const StudyData& study) {
    for (const FactorColumn& factor : study.factors) {
        columns.push_back({factor.column, "Factor " + factor.factor + " (" + factor.kind + ")", factor.unit, "text", "",
                           1, factor.levels});
    }
}

Column measureColumn(const store::MeasureRow& measure) {
    return {measure.measure,
            measure.label,
            measure.unit == "1" ? "" : measure.unit,
            "number",
            measure.formula,
            measure.formula_version,
            {}};
}

std::string feedbackOf(const store::AttemptRow& a) {
    std::string text;
    const auto add = [&](bool given, const char* name) {
        if (given) text += (text.empty() ? "" : "+") + std::string(name);
    };
    add(a.kinesthetic, "kinesthetic");
    add(a.cues.visual, "visual");
    add(a.cues.vibration, "vibrotactile");
    add(a.cues.sound, "audio");
    add(a.cues.masking, "masking_noise");
    return text.empty() ? "none" : text;
}

std::vector<std::string> trialRow(const StudyData& study, const store::AttemptRow& a) {
    std::vector<std::string> row = {a.participant_id,
                                    a.kind,
                                    a.group,
                                    cell(a.session_ordinal),
                                    a.station,
                                    a.device,
                                    cell(a.block_index),
                                    a.block,
                                    a.phase,
                                    cell(a.trial_index),
                                    cell(a.trial_in_block),
                                    cell(a.repetition),
                                    cell(a.attempt_no),
                                    a.condition};
    for (const FactorColumn& factor : study.factors) row.push_back(levelOf(a.levels, factor.factor));
    std::optional<std::int64_t> duration;
    if (a.end_ns) duration = *a.end_ns - a.start_ns;
    row.insert(row.end(),
               {secondsCell(a.start_ns), secondsCell(duration), a.outcome, cell(a.valid), cell(a.invalid_reason)});
    for (const store::MeasureRow& measure : study.measures) {
        const auto found = a.measures.find(measure.measure);
        row.push_back(found == a.measures.end() ? kMissing : cell(found->second));
    }
    row.insert(row.end(), {feedbackOf(a), a.timed_by});
    if (a.timing) {
        row.insert(row.end(), {cell(a.timing->ticks), cell(a.timing->overruns), cell(a.timing->dropped_samples)});
    } else {
        row.insert(row.end(), 3, kMissing);
    }
    row.insert(row.end(), {a.protocol_sha256, a.app_version});
    return row;
}

/// What a participant's columns tell apart: the condition's name without the levels that a group or an assignment
/// gives.
std::string seenName(const StudyData& study, const store::ConditionRow& condition) {
    std::string name;
    bool all = true, first = true;
    for (const auto& [factor, label] : condition.levels) {
        const auto column = std::find_if(study.factors.begin(), study.factors.end(),
                                         [&name = factor](const FactorColumn& c) { return c.factor == name; });
        if (column != study.factors.end() && column->kind != "within") {
            all = false;
            continue;
        }
        name += (first ? "" : "/") + label;
        first = false;
    }
    if (all) return condition.condition;
    const auto own = condition.condition.rfind('@');  // of a block's own conditions
    return name + (own == std::string::npos ? "" : condition.condition.substr(own));
}

/// Names of conditions of all protocols, in order, each with a column part of its own; catch trials have none.
std::vector<std::pair<std::string, std::string>> conditionParts(const StudyData& study,
                                                                const std::vector<Cell>& cells) {
    std::vector<std::pair<std::string, std::string>> parts;
    const auto has = [&](const std::string& text, auto member) {
        return std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return part.*member == text; });
    };
    using Part = std::pair<std::string, std::string>;
    for (const store::ConditionRow& condition : study.conditions) {
        const std::string name = seenName(study, condition);
        const bool used = cells.empty() || std::any_of(cells.begin(), cells.end(),
                                                       [&](const Cell& cell) { return cell.condition == &condition; });
        if (!used || has(name, &Part::first)) continue;
        std::string part = columnPart(name);
        while (has(part, &Part::second)) part += '_';
        parts.emplace_back(name, part);
    }
    return parts;
}

}  // namespace

std::string columnPart(const std::string& condition) {
    std::string part = condition;
    for (char& c : part) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                           c == '-' || c == '_';
        if (!plain) c = '_';
    }
    return part;
}

std::vector<Column> fixedColumns() {
    std::vector<Column> columns = leadingColumns();
    append(columns, resultColumns());
    append(columns, closingColumns());
    return columns;
}

Table makeTrials(const StudyData& study) {
    Table table{"trials.csv", "One row per attempt at a trial, whatever became of it.", leadingColumns(), {}};
    appendFactors(table.columns, study);
    append(table.columns, resultColumns());
    for (const store::MeasureRow& measure : study.measures) table.columns.push_back(measureColumn(measure));
    append(table.columns, closingColumns());
    for (const store::AttemptRow& attempt : study.attempts) table.rows.push_back(trialRow(study, attempt));
    return table;
}

Table makeCells(const StudyData& study) {
    Table table{
        "cells_long.csv", "One row per participant and condition: means, medians and counts.", whoColumns(), {}};
    table.columns.push_back({"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}});
    table.columns.push_back({"condition", "Name of the condition", "", "text", "", 1, {}});
    appendFactors(table.columns, study);
    table.columns.push_back({"n_trials", "Attempts counted", "", "integer", std::string("count ") + kCounted, 1, {}});
    table.columns.push_back({"n_success", "Attempts counted that succeeded", "", "integer", "", 1, {}});
    table.columns.push_back({"success_share", "Share of success", "", "number", "n_success / n_trials", 1, {}});
    for (const store::MeasureRow& measure : study.measures) {
        const Column base = measureColumn(measure);
        const auto add = [&](const std::string& what, const std::string& unit, const std::string& type) {
            table.columns.push_back({base.name + "." + what,
                                     base.label + ", " + what,
                                     unit,
                                     type,
                                     what + " " + kCounted + " and have a value; value: " + base.formula,
                                     base.formula_version,
                                     {}});
        };
        add("mean", base.unit, "number");
        add("median", base.unit, "number");
        add("n", "", "integer");
    }
    for (const Cell& c : cellsOf(study)) {
        std::vector<std::string> row = {c.participant_id, c.kind, c.group, c.protocol_sha256, c.condition->condition};
        for (const FactorColumn& factor : study.factors) row.push_back(levelOf(c.condition->levels, factor.factor));
        const auto trials = static_cast<std::int64_t>(c.attempts.size());
        const std::int64_t successes = std::count_if(c.attempts.begin(), c.attempts.end(),
                                                     [](const auto* attempt) { return attempt->outcome == "success"; });
        row.insert(row.end(),
                   {cell(trials), cell(successes),
                    trials == 0 ? kMissing : cell(static_cast<double>(successes) / static_cast<double>(trials))});
        for (const store::MeasureRow& measure : study.measures) {
            const std::vector<double> values = valuesOf(c.attempts, measure.measure);
            row.insert(row.end(),
                       {cell(meanOf(values)), cell(medianOf(values)), cell(static_cast<std::int64_t>(values.size()))});
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::vector<Table> makeWide(const StudyData& study) {
    const std::vector<Cell> cells = cellsOf(study);
    const auto parts = conditionParts(study, cells);
    std::vector<Table> tables;
    for (const store::MeasureRow& measure : study.measures) {
        const Column base = measureColumn(measure);
        Table table{"wide_" + base.name + ".csv",
                    "One row per participant, one column per condition: mean of " + base.name + ".",
                    whoColumns(),
                    {}};
        table.columns.push_back({"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}});
        for (const auto& [condition, part] : parts) {
            table.columns.push_back({base.name + "." + part,
                                     base.label + ", " + condition,
                                     base.unit,
                                     "number",
                                     std::string("mean ") + kCounted + " and have a value; value: " + base.formula,
                                     base.formula_version,
                                     {}});
        }
        for (std::size_t i = 0; i < cells.size();) {
            const Cell& person = cells[i];
            std::vector<std::string> row = {person.participant_id, person.kind, person.group, person.protocol_sha256};
            row.resize(4 + parts.size(), kMissing);
            for (; i < cells.size() && cells[i].participant_id == person.participant_id &&
                   cells[i].protocol_sha256 == person.protocol_sha256;
                 ++i) {
                const auto place = std::find_if(parts.begin(), parts.end(), [&](const auto& part) {
                    return part.first == seenName(study, *cells[i].condition);
                });
                row[4 + static_cast<std::size_t>(std::distance(parts.begin(), place))] =
                    cell(meanOf(valuesOf(cells[i].attempts, base.name)));
            }
            table.rows.push_back(std::move(row));
        }
        tables.push_back(std::move(table));
    }
    return tables;
}

}  // namespace passung::exporter
