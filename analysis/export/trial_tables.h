#pragma once

#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// A condition's name as part of a column's name: everything but letters, digits, '.', '-' and '_' becomes '_'.
std::string columnPart(const std::string& condition);

/// The columns of trials.csv.
std::vector<Column> trialColumns(const StudyData& study);

/// The column of a measure where a file has it as it is.
Column measureColumn(const store::MeasureRow& measure);

/// One row per attempt, whatever became of it.
Table makeTrials(const StudyData& study);

}  // namespace passung::exporter
