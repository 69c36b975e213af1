#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// One row per attempt and obstacle.
Table makeContactEnergy(const StudyData& study);

}  // namespace passung::exporter
