#pragma once

#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// Reads the [[block]] tables by the plan's factors.
std::vector<plan::Block> readBlocks(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors,
                                    Errors& errors);

/// Reports every block that design::problemsOf() finds impossible, at the key that is to blame.
/// @pre the plan is complete; its blocks were read from `tables`
void checkBlocks(const std::vector<Node>& tables, const plan::StudyPlan& plan, Errors& errors);

/// Some of the levels of a condition: by factor, the level or nothing.
using LevelPattern = std::vector<std::optional<std::size_t>>;

/// Reads `{ factor = level, ... }`; `path` names it in messages.
LevelPattern readPattern(const Node& table, const std::string& path, const std::vector<plan::Factor>& factors,
                         Errors& errors);

bool matches(const LevelPattern& pattern, const std::vector<std::size_t>& levels);

/// Reads the study's `exclude`: combinations of levels that it leaves out.
std::vector<LevelPattern> readExclusions(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors,
                                         Errors& errors);

/// True if one of them is about these levels.
bool isExcluded(const std::vector<LevelPattern>& exclusions, const std::vector<std::size_t>& levels);

}  // namespace passung::protocol
