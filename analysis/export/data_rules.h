#pragma once

#include "analysis/export/study_data.h"

namespace passung::exporter {

/// Fills in whom and what the protocols' rules leave out: first trials, then persons by what is left.
void applyRules(StudyData& study);

}  // namespace passung::exporter
