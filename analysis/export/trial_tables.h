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

/// Who it is about: the first columns of several tables.
std::vector<Column> whoColumns();

/// "order_sequence", by sequenceOf().
Column sequenceColumn();

void appendFactors(std::vector<Column>& columns, const StudyData& study);

Column measureColumn(const store::MeasureRow& measure);

/// One row per attempt, whatever became of it.
Table makeTrials(const StudyData& study);

}  // namespace passung::exporter
