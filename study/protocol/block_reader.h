#pragma once

#include <vector>

#include "study/protocol/document.h"
#include "study/protocol/study_plan.h"

namespace passung::protocol {

/// Reads the [[block]] tables by the plan's factors.
std::vector<Block> readBlocks(const std::vector<Node>& tables, const std::vector<Factor>& factors, Errors& errors);

/// Reports every block that design::problemsOf() finds impossible, at the key that is to blame.
/// @pre the plan is complete; its blocks were read from `tables`
void checkBlocks(const std::vector<Node>& tables, const StudyPlan& plan, Errors& errors);

/// Combinations of levels that a study leaves out, as it lists them: by factor, the level or nothing.
using Exclusion = std::vector<std::optional<std::size_t>>;

/// Reads the study's `exclude`.
std::vector<Exclusion> readExclusions(const std::vector<Node>& tables, const std::vector<Factor>& factors,
                                      Errors& errors);

/// True if one of them is about these levels.
bool isExcluded(const std::vector<Exclusion>& exclusions, const std::vector<std::size_t>& levels);

}  // namespace passung::protocol
