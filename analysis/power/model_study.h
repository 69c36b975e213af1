#pragma once

#include "analysis/export/study_data.h"
#include "study/protocol/study_plan.h"

namespace passung::power {

/// The only measure that modelStudy has.
inline constexpr const char* kModelMeasure = "completion_time_s";

/// The study as its exports would see it, performed by so many simulated participants without hand, device or contact:
/// real people, slots and orders of trials, but times by person::completionTime, alike in all conditions. Every trial
/// succeeds. The same plan gives the same data.
exporter::StudyData modelStudy(const protocol::StudyPlan& plan, int participants);

}  // namespace passung::power
