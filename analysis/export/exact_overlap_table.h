#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per attempt and judged tick.
/// @pre both outlive the table
Table makeExactOverlap(const StudyData& study, const store::StoreReader& reader);

}  // namespace passung::exporter
