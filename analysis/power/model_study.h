#pragma once

#include <array>

#include "analysis/export/study_data.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// The measures that modelStudy has, each the same time.
inline constexpr std::array kModelMeasures{"completion_time_s", "time_s"};
inline constexpr const char* kModelMeasure = kModelMeasures[0];

/// The study as its exports would see it, performed by so many simulated participants without hand, device or contact:
/// real people, slots and orders of trials, but times by person::completionTime, alike in all conditions. Every trial
/// succeeds. The same plan gives the same data. An error for orders that cannot be made.
Result<exporter::StudyData> modelStudy(const plan::StudyPlan& plan, int participants);

}  // namespace passung::power
