#pragma once

#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/session/participant_order.h"

namespace passung::cli {

/// The planned orders as CSV: a row for each trial with the participant's code, group, session, block, phase, trial,
/// condition and a column for each factor; what trials.csv of an export will say of them. A trial of a staircase has
/// the condition that it starts from.
std::string orderCsv(const plan::StudyPlan& plan, const std::vector<session::PlannedSession>& sessions);

}  // namespace passung::cli
