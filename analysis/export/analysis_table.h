#pragma once

#include "analysis/export/cells.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per planned analysis and block: which column of which file it takes, its formula in R's notation, and how
/// many participants it keeps.
Table makeAnalyses(const StudyData& study, const std::vector<Cell>& cells);

}  // namespace passung::exporter
