#include "analysis/export/cell_tables.h"

#include <algorithm>
#include <map>
#include <set>

#include "analysis/export/shared_columns.h"
#include "analysis/export/trial_tables.h"

namespace passung::exporter {
namespace {

constexpr const char* kCounted = "over the attempts with counted = 1 in trials.csv";
constexpr const char* kHorizon = "restricted_to_s";

const store::ViewColumn& ofCells(std::string_view name) { return store::viewColumn(store::StudyView::Cells, name); }

/// Of the restricted mean.
const std::string& restrictedFormula() { return ofCells("restricted_mean").formula; }

/// Columns that the long table and the wide ones begin with. Refers to `study`.
ColumnsOf<Cell> leadingColumns(const StudyData& study) {
    ColumnsOf<Cell> columns = whoColumns<Cell>();
    append(columns, {sequenceColumn<Cell>(study), sessionColumn<Cell>(), blockIndexColumn<Cell>(), blockColumn<Cell>(),
                     protocolColumn<Cell>()});
    return columns;
}

std::int64_t trialsOf(const Cell& cell) { return static_cast<std::int64_t>(cell.attempts.size()); }

std::int64_t successesOf(const Cell& cell) {
    return std::count_if(cell.attempts.begin(), cell.attempts.end(),
                         [](const auto* attempt) { return attempt->outcome == "success"; });
}

/// NaN without trials.
double successShare(const Cell& cell) {
    return static_cast<double>(successesOf(cell)) / static_cast<double>(trialsOf(cell));
}

/// What is said of a cell's values of a measure, of time_s too: a plain mean of censored times says too little.
struct Summary {
    const char* name;
    std::string (*text)(const std::vector<double>& values);
    const char* type;
};

constexpr Summary kSummaries[] = {
    {"mean", [](const std::vector<double>& values) { return cell(meanOf(values)); }, "number"},
    {"median", [](const std::vector<double>& values) { return cell(medianOf(values)); }, "number"},
    {"n", [](const std::vector<double>& values) { return cell(static_cast<std::int64_t>(values.size())); }, "integer"}};

/// NA of cells whose trials cannot have the measure.
ColumnOf<Cell> summaryColumn(const Column& measure, const Summary& summary) {
    const bool counts = summary.type == std::string_view("integer");
    return {measure.name + "." + summary.name,
            measure.label + ", " + summary.name,
            summary.type,
            [name = measure.name, text = summary.text](const Cell& c) {
                return canHave(*c.condition, name) ? text(valuesOf(c.attempts, name)) : kMissing;
            },
            {.unit = counts ? "" : measure.unit,
             .formula = std::string(summary.name) + " " + kCounted + " that have a value; value: " + measure.formula,
             .formula_version = measure.formula_version}};
}

/// Columns of a measure whose cells hold a restricted mean.
ColumnsOf<Cell> restrictedColumns(const Column& measure) {
    return {{cellColumn(measure.name),
             measure.label + ", restricted mean",
             "number",
             [name = measure.name](const Cell& c) { return valueOf(c, name); },
             {.unit = measure.unit, .formula = restrictedFormula()}},
            {ofCells(kHorizon), "number", &Cell::horizon_s}};
}

/// Columns of cells_long.csv. Refers to `study`.
ColumnsOf<Cell> cellColumns(const StudyData& study) {
    ColumnsOf<Cell> columns = leadingColumns(study);
    append(columns, {{ofTrials("condition"), "text", [](const Cell& c) { return c.condition->condition; }}});
    appendFactors(columns, study, [](const Cell& c) { return c.condition->levels; });
    append(columns, {{ofCells("n_trials"), "integer", trialsOf},
                     {ofCells("n_success"), "integer", successesOf},
                     {ofCells("success_share"), "number", successShare}});
    for (const store::MeasureRow& row : study.measures) {
        const Column measure = measureColumn(row);
        if (isCensored(measure.name)) append(columns, restrictedColumns(measure));
        for (const Summary& summary : kSummaries) columns.push_back(summaryColumn(measure, summary));
    }
    return columns;
}

/// What a participant's columns tell apart in a block: the condition's name without the levels that a group or an
/// assignment gives, and without the block's own name.
std::string seenName(const StudyData& study, const store::ConditionRow& condition) {
    std::string name;
    for (const auto& [factor, label] : condition.levels) {
        const auto column = std::find_if(study.factors.begin(), study.factors.end(),
                                         [&name = factor](const FactorColumn& c) { return c.factor == name; });
        if (column == study.factors.end() || column->kind == "within") name += (name.empty() ? "" : "/") + label;
    }
    return name.empty() ? condition.condition.substr(0, condition.condition.rfind('@')) : name;
}

/// A wide table's column: the conditions that share it.
struct ConditionColumn {
    std::string name, part;
};

/// The conditions of these cells, as the protocols list them; names whose parts are equal get a '_' more.
std::vector<ConditionColumn> conditionColumns(const StudyData& study, const std::vector<const Cell*>& cells) {
    std::set<const store::ConditionRow*> met;
    for (const Cell* cell : cells) met.insert(cell->condition);
    std::vector<ConditionColumn> columns;
    const auto has = [&](const std::string& text, auto member) {
        return std::any_of(columns.begin(), columns.end(), [&](const auto& column) { return column.*member == text; });
    };
    for (const store::ConditionRow& condition : study.conditions) {
        if (met.count(&condition) == 0) continue;
        const std::string name = seenName(study, condition);
        if (has(name, &ConditionColumn::name)) continue;
        std::string part = columnPart(name);
        while (has(part, &ConditionColumn::part)) part += '_';
        columns.push_back({name, part});
    }
    return columns;
}

/// A participant's cells of one block in a session.
struct WideRow {
    const Cell* first;
    std::map<std::string, double> values;  // of the measure, by a column's name
};

bool sameRow(const Cell& a, const Cell& b) {
    return a.participant_id == b.participant_id && a.protocol_sha256 == b.protocol_sha256 &&
           a.session_ordinal == b.session_ordinal && a.block_index == b.block_index;
}

std::vector<WideRow> wideRows(const StudyData& study, const std::string& measure,
                              const std::vector<const Cell*>& cells) {
    std::vector<WideRow> rows;
    for (const Cell* cell : cells) {
        if (rows.empty() || !sameRow(*rows.back().first, *cell)) rows.push_back({cell, {}});
        rows.back().values[seenName(study, *cell->condition)] = valueOf(*cell, measure);
    }
    return rows;
}

/// The values of the conditions that share a column.
ColumnOf<WideRow> valueColumn(const Column& measure, const ConditionColumn& column) {
    const bool censored = isCensored(measure.name);
    const std::string what = censored ? "restricted mean" : "mean";
    return {measure.name + "." + column.part,
            measure.label + ", " + what + " in " + column.name,
            "number",
            [name = column.name](const WideRow& row) {
                const auto value = row.values.find(name);
                return value == row.values.end() ? kMissing : cell(value->second);
            },
            {.unit = measure.unit,
             .formula = censored ? restrictedFormula() + "; restricted_to_s: see cells_long.csv"
                                 : what + " " + kCounted + " that have a value; value: " + measure.formula,
             .formula_version = measure.formula_version}};
}

/// The cells of one block that can have the measure.
Table wideTable(const StudyData& study, const Column& measure, const std::vector<const Cell*>& cells,
                std::string file) {
    const std::string what = isCensored(measure.name) ? "restricted mean" : "mean";
    ColumnsOf<WideRow> columns;
    append(columns, leadingColumns(study), [](const WideRow& row) -> const Cell& { return *row.first; });
    for (const ConditionColumn& column : conditionColumns(study, cells))
        columns.push_back(valueColumn(measure, column));
    return makeTable(std::move(file),
                     "One row per participant and session, one column per condition of block " + cells.front()->block +
                         ": " + what + " of " + measure.name + ".",
                     columns, wideRows(study, measure.name, cells));
}

}  // namespace

std::string cellColumn(const std::string& measure) {
    return measure + (isCensored(measure) ? ".restricted_mean" : ".mean");
}

Table makeCells(const StudyData& study, const std::vector<Cell>& cells) {
    return makeTable("cells_long.csv",
                     "One row per participant, session, block and condition that was planned there: means, medians, "
                     "restricted means and counts.",
                     cellColumns(study), cells);
}

std::vector<Table> makeWide(const StudyData& study, const std::vector<Cell>& cells) {
    std::vector<std::string> blocks;  // by the plans, so that a file's name does not depend on who has been there
    const auto add = [&](const std::string& block) {
        if (std::find(blocks.begin(), blocks.end(), block) == blocks.end()) blocks.push_back(block);
    };
    for (const store::ProtocolRow& protocol : study.protocols)
        std::for_each(protocol.main_blocks.begin(), protocol.main_blocks.end(), add);
    for (const Cell& cell : cells) add(cell.block);
    std::vector<Table> tables;
    std::set<std::string> taken;
    for (const store::MeasureRow& measure : study.measures) {
        const Column base = measureColumn(measure);
        for (const std::string& block : blocks) {
            std::vector<const Cell*> of;
            for (const Cell& cell : cells)
                if (cell.block == block && canHave(*cell.condition, base.name)) of.push_back(&cell);
            if (of.empty()) continue;
            std::string file = "wide_" + base.name;
            if (blocks.size() > 1) file += "_" + columnPart(block);
            while (!taken.insert(file).second) file += '_';
            tables.push_back(wideTable(study, base, of, file + ".csv"));
        }
    }
    return tables;
}

}  // namespace passung::exporter
