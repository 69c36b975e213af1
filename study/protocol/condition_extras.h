#pragma once

#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"

namespace passung::protocol {

/// Reads what a condition has beside scene and task: feedback, secondary task, and who times the trial. Adds everything
/// that is wrong to `errors`.
void readConditionExtras(const StudyTables& tables, plan::Condition& condition, Errors& errors);

}  // namespace passung::protocol
