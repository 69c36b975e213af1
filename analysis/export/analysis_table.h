#pragma once

#include <algorithm>

#include "analysis/export/cells.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// A planned analysis where its values are: of a measure in a block or over blocks, of a questionnaire's scale, or of a
/// staircase's thresholds. Refers to its study.
struct PlannedTest {
    const store::AnalysisRow* analysis = nullptr;
    std::vector<std::string> factors, within;  // columns; within: those of `factors` that vary within participants
    std::string block;                         // empty: all that there are, or thresholds
    std::string value;                         // its column in file()
    std::int64_t counted = 0;                  // participants who were to have the outcome there
    std::int64_t complete = 0;                 // of these with a value at every combination of the factors

    bool ofThresholds() const { return analysis->outcome.empty(); }
    bool ofScale() const { return analysis->outcome.find('.') != std::string::npos; }
    bool ofTrials() const { return analysis->test == "survival"; }
    const char* file() const {
        return ofThresholds() ? "thresholds.csv"
               : ofScale()    ? "questionnaire_scores.csv"
               : ofTrials()   ? "trials.csv"
                              : "cells_long.csv";
    }
    bool overBlocks() const { return std::find(factors.begin(), factors.end(), plan::kBlockFactor) != factors.end(); }
};

/// By protocol and number, then block.
std::vector<PlannedTest> plannedTests(const StudyData& study, const std::vector<Cell>& cells);

/// One row per planned analysis and block: which column of which file it takes, its formula in R's notation, and how
/// many participants it keeps.
Table makeAnalyses(const StudyData& study, const std::vector<Cell>& cells);

}  // namespace passung::exporter
