#pragma once

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

// Columns of thresholds.csv: in the key's unit and, of a staircase with a logarithmic axis, in decades.
inline constexpr const char* kThreshold = "estimate";
inline constexpr const char* kLogThreshold = "log10_estimate";

/// One row per attempt at a trial of a staircase: what was presented, what came of it, the estimate after it.
Table makeStaircase(const StudyData& study);

/// One row per participant, staircase, condition and track of the counted sessions: the estimate by the answers that
/// count.
Table makeThresholds(const StudyData& study);

}  // namespace passung::exporter
