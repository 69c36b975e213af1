#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per attempt that a window showed.
Table makePresentation(const StudyData& study);

}  // namespace passung::exporter
