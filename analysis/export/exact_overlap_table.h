#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per attempt and judged tick.
Table makeExactOverlap(const StudyData& study);

}  // namespace passung::exporter
