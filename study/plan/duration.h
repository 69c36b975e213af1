#pragma once

#include <span>

#include "study/design/trial_order.h"
#include "study/plan/study_plan.h"

namespace passung::plan {

/// How long these trials of one session take if each lasts to its time-out and rests are as short as they may be [s].
/// Not in it: ways to the start (that to a pair's second interval is reckoned with 2 s), repeated attempts,
/// questionnaires.
double longestDuration(const StudyPlan& plan, std::span<const design::PlannedTrial> trials);

/// The longest of all groups' sessions by that reckoning [s]. @pre the plan's design can be run
double longestSession(const StudyPlan& plan);

}  // namespace passung::plan
