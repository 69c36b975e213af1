#pragma once

#include <string>
#include <vector>

#include "analysis/export/cells.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// The column of cells_long.csv that an analysis takes for a measure.
std::string cellColumn(const std::string& measure);

/// One row per participant, session, block and condition: means, medians, restricted means and counts.
Table makeCells(const StudyData& study, const std::vector<Cell>& cells);

/// One table per measure and block that can have it, one row per participant and session, one column per condition.
std::vector<Table> makeWide(const StudyData& study, const std::vector<Cell>& cells);

}  // namespace passung::exporter
