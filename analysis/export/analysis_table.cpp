#include "analysis/export/analysis_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/export/cell_tables.h"
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

std::vector<Column> analysisColumns() {
    return {
        {"protocol_sha256", "SHA-256 of the protocol's text", "", "text", "", 1, {}},
        {"analysis", "Number in the protocol, from 1", "", "integer", "", 1, {}},
        {"outcome", "Measure that is analysed; NA: thresholds", "", "text", "", 1, {}},
        {"staircase", "Staircase whose thresholds are analysed; NA: a measure", "", "text", "", 1, {}},
        {"block", "Block whose trials are analysed; NA: of a staircase", "", "text", "", 1, {}},
        {"factors", "Factors, parted by ;", "", "text", "", 1, {}},
        {"test", "Test that the protocol names", "", "text", "", 1, {}},
        {"file", "File that has the values: its rows of this protocol and block, or staircase", "", "text", "", 1, {}},
        {"value_column", "Its column", "", "text", "", 1, {}},
        {"r_formula", "The model in R's notation, for the data of r_call", "", "text", "", 1, {}},
        {"r_call",
         "The test as a call of R (lmm: with the package lme4) on data: the rows of the file that belong here, "
         "averaged "
         "by participant and factors, these as factor(), without whoever lacks a combination: data <- "
         "aggregate(rows[value_column], lapply(rows[c(\"participant_id\", factors)], factor), mean)",
         "",
         "text",
         "",
         1,
         {}},
        {"n_participants", "Participants who count and were to have the outcome there", "", "integer", "", 1, {}},
        {"n_complete",
         "Of these who have a value at every combination of the factors: whom complete cases keep",
         "",
         "integer",
         "",
         1,
         {}}};
}

}  // namespace

Table makeAnalyses(const StudyData& study, const std::vector<Cell>& cells) {
    Table table{"analyses.csv", "One row per analysis that the protocol plans, and block.", analysisColumns(), {}};
    for (const store::AnalysisRow& analysis : study.analyses) {
        const Factors factors = factorsOf(study, analysis);
        const bool thresholds = analysis.outcome.empty();
        const std::string value = !thresholds                      ? cellColumn(analysis.outcome)
                                  : isLogarithmic(study, analysis) ? kLogThreshold
                                                                   : kThreshold;
        const auto add = [&](const std::string& block, const Kept& kept) {
            if (kept.people.empty()) return;
            table.rows.push_back({analysis.protocol_sha256, cell(analysis.number),
                                  thresholds ? kMissing : analysis.outcome, thresholds ? analysis.staircase : kMissing,
                                  thresholds ? kMissing : block, joined(factors.all, ";"), analysis.test,
                                  thresholds ? "thresholds.csv" : "cells_long.csv", value,
                                  formulaText(value, analysis.test, factors), callText(value, analysis.test, factors),
                                  cell(kept.counted()), cell(kept.complete())});
        };
        if (thresholds) {
            add("", keptBy(study, analysis, factors));
            continue;
        }
        std::vector<std::string> blocks;
        for (const Cell& cell : cells)
            if ((analysis.block.empty() || analysis.block == cell.block) &&
                std::find(blocks.begin(), blocks.end(), cell.block) == blocks.end())
                blocks.push_back(cell.block);
        for (const std::string& block : blocks) add(block, keptBy(study, analysis, block, cells));
    }
    return table;
}

}  // namespace passung::exporter
