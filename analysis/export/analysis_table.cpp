#include "analysis/export/analysis_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/export/cell_tables.h"
#include "analysis/export/counted_forms.h"
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
    for (const std::string& name : analysis.factors) {
        const auto column = std::find_if(study.factors.begin(), study.factors.end(),
                                         [&](const FactorColumn& c) { return c.factor == name; });
        const bool known = column != study.factors.end();  // else: which block
        factors.all.push_back(known ? column->column : name);
        if (!known || column->kind != "between") factors.within.push_back(factors.all.back());
    }
    return factors;
}

std::string valueText(const PlannedTest& planned) {
    return planned.analysis->transform.empty() ? planned.value
                                               : planned.analysis->transform + "(" + planned.value + ")";
}

/// The model in R's notation; one row a participant and combination of the factors' levels, of `survival` a trial.
std::string formulaText(const PlannedTest& planned) {
    const store::AnalysisRow& analysis = *planned.analysis;
    const std::string& test = analysis.test;
    const std::string value = valueText(planned);
    const Factors factors{planned.factors, planned.within};
    std::string effects =
        factors.all.empty() ? "1" : joined(factors.all, test == "survival" || test == "ordinal" ? " + " : " * ");
    for (const std::string& covariate : analysis.covariates) effects += " + " + covariate;
    if (test == "survival")
        return "survival::Surv(time_s, finished) ~ " + effects +
               (factors.within.size() == factors.all.size() ? " + strata(participant_id)" : "");
    if (test == "ordinal") return "ordered(" + value + ") ~ " + effects + " + (1 | participant_id)";
    if (test == "rm_anova" || test == "mixed_anova")
        return value + " ~ " + effects + " + Error(participant_id / (" + joined(factors.within, " * ") + "))";
    if (test == "friedman") return value + " ~ " + effects + " | participant_id";
    if (test == "lmm") return value + " ~ " + effects + " + (1 | participant_id)";
    return value + " ~ " + effects;
}

/// The test as a call of R on `data`. R's formulas for two samples know no pairs from 4.4 on: the samples are split.
std::string callText(const PlannedTest& planned) {
    const std::string formula = formulaText(planned), value = valueText(planned);
    const std::string& test = planned.analysis->test;
    const auto paired = [&](const char* function, const char* more = "") {
        return "with(data[order(data$participant_id), ], do.call(" + std::string(function) + ", c(unname(split(" +
               value + ", " + joined(planned.factors, ", ") + ")), paired = TRUE" + more + ")))";
    };
    const auto plain = [&](const char* function) { return function + ("(" + formula + ", data = data)"); };
    if (test == "paired_t") return paired("t.test");
    if (test == "wilcoxon") return paired("wilcox.test");
    if (test == "friedman") return plain("friedman.test");
    if (test == "mann_whitney") return plain("wilcox.test");
    if (test == "equivalence")
        return planned.within.empty() ? "t.test(" + formula + ", data = data, conf.level = 0.9)"
                                      : paired("t.test", ", conf.level = 0.9");
    if (test == "lmm") return plain("lme4::lmer");
    if (test == "ordinal") return plain("ordinal::clmm");
    if (test == "survival")
        return "survival::coxph(" + formula + ", data = data" +
               (planned.within.size() == planned.factors.size() ? "" : ", cluster = participant_id") + ")";
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

/// Of the analysis' factors but those between participants.
Names levelsWithin(const StudyData& study, const store::AnalysisRow& analysis, const store::ConditionRow* condition,
                   const std::string& block) {
    Names levels;
    for (const std::string& factor : analysis.factors) {
        const auto column = std::find_if(study.factors.begin(), study.factors.end(),
                                         [&](const FactorColumn& c) { return c.factor == factor; });
        if (column == study.factors.end())
            levels.push_back(block);
        else if (column->kind != "between")
            levels.push_back(condition == nullptr ? kMissing : levelOf(condition->levels, factor));
    }
    return levels;
}

/// The same of a questionnaire's scale, by its forms that count.
Kept keptByForms(const StudyData& study, const store::AnalysisRow& analysis) {
    Kept kept;
    for (const store::QuestionnaireRunRow* run : countedRuns(study)) {
        if (run->protocol_sha256 != analysis.protocol_sha256 ||
            !analysis.outcome.starts_with(run->questionnaire + ".") ||
            (!analysis.block.empty() && run->block != analysis.block))
            continue;
        const auto condition =
            std::find_if(study.conditions.begin(), study.conditions.end(), [&](const store::ConditionRow& row) {
                return row.protocol_sha256 == run->protocol_sha256 && row.condition == run->condition;
            });
        const Names levels = levelsWithin(study, analysis, condition == study.conditions.end() ? nullptr : &*condition,
                                          run->block.value_or(kMissing));
        bool& has = kept.people[run->participant_id][levels];
        for (const store::ScoreRow& score : run->scores)
            has = has || (score.value && analysis.outcome == run->questionnaire + "." + score.scale);
    }
    return kept;
}

Kept keptBy(const StudyData& study, const store::AnalysisRow& analysis, const std::string& block,
            const std::vector<Cell>& cells) {
    Kept kept;
    for (const Cell& cell : cells) {
        if (cell.protocol_sha256 != analysis.protocol_sha256 || (!block.empty() && cell.block != block) ||
            !canHave(*cell.condition, analysis.outcome))
            continue;
        const Names levels = levelsWithin(study, analysis, cell.condition, cell.block);
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
    return {
        protocolColumn<AnalysisRow>(),
        {"analysis", "Number in the protocol, from 1", "integer", &AnalysisRow::number},
        {"outcome", "Measure or questionnaire.scale that is analysed; NA: thresholds", "text", &AnalysisRow::outcome},
        {"staircase", "Staircase whose thresholds are analysed; NA: a measure", "text",
         [](const AnalysisRow& analysis) { return analysis.outcome.empty() ? analysis.staircase : kMissing; }}};
}

ColumnsOf<PlannedTest> plannedTestColumns() {
    ColumnsOf<PlannedTest> columns;
    append(columns, analysisColumns(),
           [](const PlannedTest& planned) -> const store::AnalysisRow& { return *planned.analysis; });
    append(columns,
           {{"block", "Block whose trials are analysed; NA: of a staircase, of forms, or of all blocks", "text",
             &PlannedTest::block},
            {"factors", "Factors, parted by ;", "text",
             [](const PlannedTest& planned) { return joined(planned.factors, ";"); }},
            {"test", "Test that the protocol names", "text",
             [](const PlannedTest& planned) { return planned.analysis->test; }},
            {"file", "File that has the values: its rows of this protocol and block, or staircase, or scale", "text",
             &PlannedTest::file},
            {"value_column", "Its column", "text", &PlannedTest::value},
            {"r_formula", "The model in R's notation, for the data of r_call", "text", formulaText},
            {"r_call",
             "The test as a call of R (lmm: with the package lme4) on data: the rows of the file that belong here, "
             "averaged "
             "by participant and factors, these as factor(), without whoever lacks a combination: data <- "
             "aggregate(rows[value_column], lapply(rows[c(\"participant_id\", factors)], factor), mean)",
             "text", callText},
            {"role", "What hangs on it by the protocol: primary, secondary, exploratory", "text",
             [](const PlannedTest& planned) { return planned.analysis->role; }},
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
        if (analysis.outcome.find('.') != std::string::npos) {
            add(analysis, factors, analysis.block, "score", keptByForms(study, analysis));
            continue;
        }
        const std::string value = analysis.test == "survival" ? analysis.outcome : cellColumn(analysis.outcome);
        if (std::find(factors.all.begin(), factors.all.end(), plan::kBlockFactor) != factors.all.end()) {
            add(analysis, factors, "", value, keptBy(study, analysis, "", cells));
            continue;
        }
        for (const std::string& block : blocksOf(analysis, cells))
            add(analysis, factors, block, value, keptBy(study, analysis, block, cells));
    }
    return tests;
}

Table makeAnalyses(const StudyData& study, const std::vector<Cell>& cells) {
    return makeTable("analyses.csv", "One row per analysis that the protocol plans, and block.", plannedTestColumns(),
                     plannedTests(study, cells));
}

}  // namespace passung::exporter
