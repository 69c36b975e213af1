#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/session/participant_order.h"

namespace passung::session {

/// What a study consists of, for an experimenter to read before the first participant: factors, conditions, blocks,
/// everyone's order, how even the orders are, how long a session takes at most, and planWarnings(). `participants`
/// > 0 get the codes P001, P002 … (orders of random blocks depend on the code).
/// With several `stations` they take part there in turn, as PA001, PB001 ….
/// Errors: constraints that no order keeps to.
Result<std::string> describePlan(const plan::StudyPlan& plan, int participants, int stations = 1);

/// How even the orders of participants with these places are; empty if there is nothing to balance.
std::string describeBalance(const plan::StudyPlan& plan, const std::vector<DesignPlace>& places);

/// What is allowed, but the experimenter should know: the reader's warnings, and numbers that leave orders unbalanced.
std::vector<std::string> planWarnings(const plan::StudyPlan& plan);

}  // namespace passung::session
