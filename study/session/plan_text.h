#pragma once

#include <string>

#include "study/protocol/study_plan.h"

namespace passung::session {

/// What a study consists of, for an experimenter to read before the first participant: factors, conditions, blocks,
/// everyone's order, how even the orders are, how long a session takes at most, and the plan's warnings. `participants`
/// > 0 get the codes P001, P002 … (orders of random blocks depend on the code).
std::string describePlan(const protocol::StudyPlan& plan, int participants);

}  // namespace passung::session
