#pragma once

#include <span>

#include "study/design/trial_order.h"
#include "study/protocol/study_plan.h"

namespace passung::protocol {

/// How long these trials of one session take at most [s]: every trial to its time-out, rests as short as they may be.
double longestDuration(const StudyPlan& plan, std::span<const design::PlannedTrial> trials);

/// The most that any session of any group takes [s]. @pre the plan's design can be run
double longestSession(const StudyPlan& plan);

}  // namespace passung::protocol
