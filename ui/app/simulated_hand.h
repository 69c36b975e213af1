#pragma once

#include <string>

#include "devices/simulated/hand_params.h"
#include "study/protocol/study_plan.h"

namespace passung::app {

/// The arm, senses and habits of the simulated participant `code`: the same in every trial and session of the study.
simulated::HandParams simulatedHand(const protocol::StudyPlan& plan, const std::string& code);

}  // namespace passung::app
