#include "analysis/export/cell_tables.h"

#include <algorithm>
#include <set>

#include "analysis/export/trial_tables.h"

namespace passung::exporter {
namespace {

constexpr const char* kCounted = "over the attempts with counted = 1 in trials.csv";
constexpr const char* kHorizon = "restricted_to_s";
constexpr const char* kRestricted =
    "area under the Kaplan-Meier curve of time_s with finished from 0 to restricted_to_s, carried on level after the "
    "last time: the mean of min(time_s, restricted_to_s) where whatever is not finished ended at a time-out";

std::vector<Column> cellColumns() {
    std::vector<Column> columns = whoColumns();
    const std::vector<Column> more = {
        sequenceColumn(),
        {"session", "Number of the participant's session, from 1", "", "integer", "", 1, {}},
        {"block_index", "Number of the block, from 0", "", "integer", "", 1, {}},
        {"block", "Name of the block", "", "text", "", 1, {}},
        {"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}}};
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
}

std::vector<std::string> cellCells(const StudyData& study, const Cell& c) {
    return {
        c.participant_id,    c.kind,  c.group,          sequenceOf(study, c.participant_id), cell(c.session_ordinal),
        cell(c.block_index), c.block, c.protocol_sha256};
}

/// Of time_s too: a plain mean of censored times says too little.
struct Summary {
    const char* name;
    std::string (*value)(const Cell&, const std::string&);
    const char* type;
};

constexpr Summary kSummaries[] = {
    {"mean", [](const Cell& c, const std::string& m) { return cell(meanOf(valuesOf(c.attempts, m))); }, "number"},
    {"median", [](const Cell& c, const std::string& m) { return cell(medianOf(valuesOf(c.attempts, m))); }, "number"},
    {"n",
     [](const Cell& c, const std::string& m) {
         return cell(static_cast<std::int64_t>(valuesOf(c.attempts, m).size()));
     },
     "integer"}};

void addSummaries(const StudyData& study, std::vector<Column>& columns) {
    for (const store::MeasureRow& measure : study.measures) {
        const Column base = measureColumn(measure);
        if (isCensored(base.name)) {
            columns.push_back(
                {cellColumn(base.name), base.label + ", restricted mean", base.unit, "number", kRestricted, 1, {}});
            columns.push_back({kHorizon,
                               "Up to where that mean goes: the shortest time-out of the block's conditions",
                               "s",
                               "number",
                               "where the stored plan tells no time-out: the longest time_s of the block",
                               1,
                               {}});
        }
        for (const Summary& summary : kSummaries) {
            const bool counts = summary.type == std::string_view("integer");
            columns.push_back(
                {base.name + "." + summary.name,
                 base.label + ", " + summary.name,
                 counts ? "" : base.unit,
                 summary.type,
                 std::string(summary.name) + " " + kCounted + " that have a value; value: " + base.formula,
                 base.formula_version,
                 {}});
        }
    }
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
struct WideColumn {
    std::string name, part;
};

/// The conditions of these cells, as the protocols list them; names whose parts are equal get a '_' more.
std::vector<WideColumn> wideColumns(const StudyData& study, const std::vector<const Cell*>& cells) {
    std::set<const store::ConditionRow*> met;
    for (const Cell* cell : cells) met.insert(cell->condition);
    std::vector<WideColumn> columns;
    const auto has = [&](const std::string& text, auto member) {
        return std::any_of(columns.begin(), columns.end(), [&](const auto& column) { return column.*member == text; });
    };
    for (const store::ConditionRow& condition : study.conditions) {
        if (met.count(&condition) == 0) continue;
        const std::string name = seenName(study, condition);
        if (has(name, &WideColumn::name)) continue;
        std::string part = columnPart(name);
        while (has(part, &WideColumn::part)) part += '_';
        columns.push_back({name, part});
    }
    return columns;
}

/// The cells of one block that can have the measure.
Table wideTable(const StudyData& study, const Column& base, const std::vector<const Cell*>& cells, std::string file) {
    const std::string what = isCensored(base.name) ? "restricted mean" : "mean";
    Table table{std::move(file),
                "One row per participant and session, one column per condition of block " + cells.front()->block +
                    ": " + what + " of " + base.name + ".",
                cellColumns(),
                {}};
    const auto fixed = table.columns.size();
    const auto columns = wideColumns(study, cells);
    for (const auto& [condition, part] : columns)
        table.columns.push_back({base.name + "." + part,
                                 base.label + ", " + what + " in " + condition,
                                 base.unit,
                                 "number",
                                 isCensored(base.name)
                                     ? std::string(kRestricted) + "; restricted_to_s: see cells_long.csv"
                                     : what + " " + kCounted + " that have a value; value: " + base.formula,
                                 base.formula_version,
                                 {}});
    for (std::size_t i = 0; i < cells.size();) {
        const Cell& first = *cells[i];
        std::vector<std::string> row = cellCells(study, first);
        row.resize(fixed + columns.size(), kMissing);
        for (; i < cells.size() && cells[i]->participant_id == first.participant_id &&
               cells[i]->protocol_sha256 == first.protocol_sha256 &&
               cells[i]->session_ordinal == first.session_ordinal && cells[i]->block_index == first.block_index;
             ++i) {
            const std::string name = seenName(study, *cells[i]->condition);
            for (std::size_t k = 0; k < columns.size(); ++k)
                if (columns[k].name == name) row[fixed + k] = cell(valueOf(*cells[i], base.name));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

std::string cellColumn(const std::string& measure) {
    return measure + (isCensored(measure) ? ".restricted_mean" : ".mean");
}

Table makeCells(const StudyData& study, const std::vector<Cell>& cells) {
    Table table{"cells_long.csv",
                "One row per participant, session, block and condition that was planned there: means, medians, "
                "restricted means and counts.",
                cellColumns(),
                {}};
    table.columns.push_back({"condition", "Name of the condition", "", "text", "", 1, {}});
    appendFactors(table.columns, study);
    table.columns.push_back({"n_trials", "Attempts counted", "", "integer", std::string("count ") + kCounted, 1, {}});
    table.columns.push_back({"n_success", "Attempts counted that succeeded", "", "integer", "", 1, {}});
    table.columns.push_back({"success_share", "Share of success", "", "number", "n_success / n_trials", 1, {}});
    addSummaries(study, table.columns);
    for (const Cell& c : cells) {
        std::vector<std::string> row = cellCells(study, c);
        row.push_back(c.condition->condition);
        for (const FactorColumn& factor : study.factors) row.push_back(levelOf(c.condition->levels, factor.factor));
        const auto trials = static_cast<std::int64_t>(c.attempts.size());
        const std::int64_t successes = std::count_if(c.attempts.begin(), c.attempts.end(),
                                                     [](const auto* attempt) { return attempt->outcome == "success"; });
        row.insert(row.end(),
                   {cell(trials), cell(successes),
                    trials == 0 ? kMissing : cell(static_cast<double>(successes) / static_cast<double>(trials))});
        for (const store::MeasureRow& measure : study.measures) {
            const std::string& name = measure.measure;
            const bool can = canHave(*c.condition, name);
            if (isCensored(name)) row.insert(row.end(), {cell(valueOf(c, name)), cell(c.horizon_s)});
            for (const Summary& summary : kSummaries) row.push_back(can ? summary.value(c, name) : kMissing);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
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
