#include "analysis/export/analysis_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/export/cell_tables.h"
#include "analysis/export/shared_columns.h"
#include "analysis/export/staircase_tables.h"

namespace passung::exporter {
namespace {

using Names = std::vector<std::string>;

/// The columns of an analysis' factors, within and between.
struct Factors {
    Names all, within;
};

Factors factorsOf(const StudyData& study, const store::AnalysisRow& analysis) {
    Factors factors;
    for (const std::string& name : analysis.factors)
        for (const FactorColumn& column : study.factors) {
            if (column.factor != name) continue;
            factors.all.push_back(column.column);
            if (column.kind != "between") factors.within.push_back(column.column);
        }
    return factors;
}

/// The model in R's notation; one row a participant and combination of the factors' levels.
std::string formulaText(const std::string& value, const std::string& test, const Factors& factors) {
    const std::string effects = factors.all.empty() ? "1" : joined(factors.all, " * ");
    if (test == "rm_anova" || test == "mixed_anova")
        return value + " ~ " + effects + " + Error(participant_id / (" + joined(factors.within, " * ") + "))";
    if (test == "friedman") return value + " ~ " + effects + " | participant_id";
    if (test == "lmm") return value + " ~ " + effects + " + (1 | participant_id)";
    return value + " ~ " + effects;
}

/// The test as a call of R on `data`. R's formulas for two samples know no pairs from 4.4 on: the samples are split.
std::string callText(const std::string& value, const std::string& test, const Factors& factors) {
    const std::string formula = formulaText(value, test, factors);
    const auto paired = [&](const char* function) {
        return "with(data[order(data$participant_id), ], do.call(" + std::string(function) + ", c(unname(split(" +
               value + ", " + joined(factors.all, ", ") + ")), paired = TRUE)))";
    };
    const auto plain = [&](const char* function) { return function + ("(" + formula + ", data = data)"); };
    if (test == "paired_t") return paired("t.test");
    if (test == "wilcoxon") return paired("wilcox.test");
    if (test == "friedman") return plain("friedman.test");
    if (test == "mann_whitney") return plain("wilcox.test");
    if (test == "lmm") return plain("lme4::lmer");
    if (test == "rm_anova" || test == "mixed_anova") return "summary(" + plain("aov") + ")";
    return plain("t.test");
}

bool isLogarithmic(const StudyData& study, const store::AnalysisRow& analysis) {
    return std::any_of(study.staircase_tracks.begin(), study.staircase_tracks.end(), [&](const auto& track) {
        return track.protocol_sha256 == analysis.protocol_sha256 && track.staircase == analysis.staircase &&
               track.params.logarithmic;
    });
}

/// Who has which combination of the within factors' levels, with a value or without.
struct Kept {
    std::map<std::string, std::map<Names, bool>> people;

    std::int64_t counted() const { return static_cast<std::int64_t>(people.size()); }
    /// With a value wherever anybody was to have one.
    std::int64_t complete() const {
        std::set<Names> all;
        for (const auto& [code, values] : people)
            for (const auto& [levels, has] : values) all.insert(levels);
        return std::count_if(people.begin(), people.end(), [&](const auto& person) {
            return person.second.size() == all.size() &&
                   std::all_of(person.second.begin(), person.second.end(), [](const auto& v) { return v.second; });
        });
    }
};

Kept keptBy(const StudyData& study, const store::AnalysisRow& analysis, const std::string& block,
            const std::vector<Cell>& cells) {
    Kept kept;
    for (const Cell& cell : cells) {
        if (cell.protocol_sha256 != analysis.protocol_sha256 || cell.block != block ||
            !canHave(*cell.condition, analysis.outcome))
            continue;
        Names levels;
        for (const std::string& factor : analysis.factors)
            for (const FactorColumn& column : study.factors)
                if (column.factor == factor && column.kind != "between")
                    levels.push_back(levelOf(cell.condition->levels, factor));
        bool& has = kept.people[cell.participant_id][levels];
        has = has || std::isfinite(valueOf(cell, analysis.outcome));
    }
    return kept;
}

/// The same of a staircase, by the rows of its thresholds.
Kept keptBy(const StudyData& study, const store::AnalysisRow& analysis, const Factors& factors) {
    const Table thresholds = makeThresholds(study);
    const auto column = [&](const std::string& name) {
        const auto found = std::find_if(thresholds.columns.begin(), thresholds.columns.end(),
                                        [&](const Column& c) { return c.name == name; });
        return static_cast<std::size_t>(found - thresholds.columns.begin());
    };
    Kept kept;
    for (const auto& row : thresholds.rows) {
        if (row[column("protocol_sha256")] != analysis.protocol_sha256 ||
            row[column("staircase")] != analysis.staircase)
            continue;
        Names levels;
        for (const std::string& factor : factors.within) levels.push_back(row[column(factor)]);
        bool& has = kept.people[row[column("participant_id")]][levels];
        has = has || row[column(kThreshold)] != kMissing;
    }
    return kept;
}

ColumnsOf<store::AnalysisRow> analysisColumns() {
    using store::AnalysisRow;
    return {protocolColumn<AnalysisRow>(),
            {"analysis", "Number in the protocol, from 1", "integer", &AnalysisRow::number},
            {"outcome", "Measure that is analysed; NA: thresholds", "text", &AnalysisRow::outcome},
            {"staircase", "Staircase whose thresholds are analysed; NA: a measure", "text",
             [](const AnalysisRow& analysis) { return analysis.outcome.empty() ? analysis.staircase : kMissing; }}};
}

ColumnsOf<PlannedTest> plannedTestColumns() {
    ColumnsOf<PlannedTest> columns;
    append(columns, analysisColumns(),
           [](const PlannedTest& planned) -> const store::AnalysisRow& { return *planned.analysis; });
    append(columns,
           {{"block", "Block whose trials are analysed; NA: of a staircase", "text", &PlannedTest::block},
            {"factors", "Factors, parted by ;", "text",
             [](const PlannedTest& planned) { return joined(planned.factors, ";"); }},
            {"test", "Test that the protocol names", "text",
             [](const PlannedTest& planned) { return planned.analysis->test; }},
            {"file", "File that has the values: its rows of this protocol and block, or staircase", "text",
             [](const PlannedTest& planned) { return planned.ofThresholds() ? "thresholds.csv" : "cells_long.csv"; }},
            {"value_column", "Its column", "text", &PlannedTest::value},
            {"r_formula", "The model in R's notation, for the data of r_call", "text",
             [](const PlannedTest& planned) {
                 return formulaText(planned.value, planned.analysis->test, {planned.factors, planned.within});
             }},
            {"r_call",
             "The test as a call of R (lmm: with the package lme4) on data: the rows of the file that belong here, "
             "averaged "
             "by participant and factors, these as factor(), without whoever lacks a combination: data <- "
             "aggregate(rows[value_column], lapply(rows[c(\"participant_id\", factors)], factor), mean)",
             "text",
             [](const PlannedTest& planned) {
                 return callText(planned.value, planned.analysis->test, {planned.factors, planned.within});
             }},
            {"n_participants", "Participants who count and were to have the outcome there", "integer",
             &PlannedTest::counted},
            {"n_complete", "Of these who have a value at every combination of the factors: whom complete cases keep",
             "integer", &PlannedTest::complete}});
    return columns;
}

/// Blocks that have cells of the analysis, in their order.
Names blocksOf(const store::AnalysisRow& analysis, const std::vector<Cell>& cells) {
    Names blocks;
    for (const Cell& cell : cells)
        if ((analysis.block.empty() || analysis.block == cell.block) &&
            std::find(blocks.begin(), blocks.end(), cell.block) == blocks.end())
            blocks.push_back(cell.block);
    return blocks;
}

}  // namespace

std::vector<PlannedTest> plannedTests(const StudyData& study, const std::vector<Cell>& cells) {
    std::vector<PlannedTest> tests;
    const auto add = [&tests](const store::AnalysisRow& analysis, const Factors& factors, const std::string& block,
                              const std::string& value, const Kept& kept) {
        if (!kept.people.empty())
            tests.push_back({&analysis, factors.all, factors.within, block, value, kept.counted(), kept.complete()});
    };
    for (const store::AnalysisRow& analysis : study.analyses) {
        const Factors factors = factorsOf(study, analysis);
        if (analysis.outcome.empty()) {
            const char* value = isLogarithmic(study, analysis) ? kLogThreshold : kThreshold;
            add(analysis, factors, "", value, keptBy(study, analysis, factors));
            continue;
        }
        for (const std::string& block : blocksOf(analysis, cells))
            add(analysis, factors, block, cellColumn(analysis.outcome), keptBy(study, analysis, block, cells));
    }
    return tests;
}

Table makeAnalyses(const StudyData& study, const std::vector<Cell>& cells) {
    return makeTable("analyses.csv", "One row per analysis that the protocol plans, and block.", plannedTestColumns(),
                     plannedTests(study, cells));
}

}  // namespace passung::exporter
