#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per attempt at an assembly and step of it.
Table makeAssemblySteps(const StudyData& study);

}  // namespace passung::exporter
