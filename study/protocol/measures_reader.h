#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// The study's `measures`; without it all that trials of its types can have. `plan` has its conditions, or (nullptr)
/// nobody knows the types of its trials.
std::vector<std::string> readMeasures(const TableReader& root, const plan::StudyPlan* plan,
                                      std::span<const std::string> known_measures, Errors& errors);

}  // namespace passung::protocol
