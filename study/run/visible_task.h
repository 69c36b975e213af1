#pragma once

#include "devices/simulated/hand_params.h"
#include "study/plan/study_plan.h"

namespace passung::run {

/// What the display shows of a condition's task: parts where they are drawn, and what is asked for.
simulated::VisibleTask visibleTask(const plan::Condition& condition);

}  // namespace passung::run
