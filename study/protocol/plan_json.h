#pragma once

#include <string>

#include "study/plan/study_plan.h"

namespace passung::protocol {

/// {"factor": "label", ...}
std::string levelsJson(const std::vector<plan::Factor>& factors, const std::vector<std::size_t>& levels);

/// Every resolved number of a condition, SI units in the names. Equal conditions give equal bytes.
std::string paramsJson(const plan::Condition& condition);

/// Factors, conditions and blocks of a plan whose other members are filled.
std::string expandedJson(const plan::StudyPlan& plan);

}  // namespace passung::protocol
