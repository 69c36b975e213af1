#pragma once

#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// A condition's name as part of a column's name: everything but letters, digits, '.', '-' and '_' becomes '_'.
std::string columnPart(const std::string& condition);

/// The columns of trials.csv that every study has; factors and measures come in between.
std::vector<Column> fixedColumns();

/// One row per attempt, whatever became of it.
Table makeTrials(const StudyData& study);

/// One row per participant and condition: means, medians and counts.
Table makeCells(const StudyData& study);

/// One table per measure, one row per participant, one column per condition.
std::vector<Table> makeWide(const StudyData& study);

}  // namespace passung::exporter
