#pragma once

#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// Reads the `conditions` of the [[block]] tables: which of the plan's shared conditions each of its blocks has. An
/// item is a condition's name, or a table of some of its levels for all conditions with these. A block with catch
/// trials has all conditions of catch trials besides, unless it lists some. Errors: also a condition that is listed
/// twice, and what tells the levels of a nuisance factor apart.
/// @pre the plan's shared conditions are read, and its blocks from `tables`
void chooseConditions(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors, plan::StudyPlan& plan,
                      Errors& errors);

}  // namespace passung::protocol
