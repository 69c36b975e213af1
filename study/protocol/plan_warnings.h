#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/protocol/study_plan.h"

namespace passung::protocol {

/// Sentences about what conditions allow and an experimenter should know, each with their names.
std::vector<std::string> conditionWarnings(std::span<const Condition> conditions);

/// The same about its main blocks. One that a staircase governs repeats what its tracks lack anyway.
std::vector<std::string> blockWarnings(const StudyPlan& plan);

}  // namespace passung::protocol
