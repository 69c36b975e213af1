#pragma once

#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// Reads the [[analysis]] tables: what the study means to test, fixed before the first participant. Errors: an outcome
/// that the study does not store, a block or factors that it does not have or that the test is not for.
/// `staircases`: the names of those that the study has.
std::vector<plan::Analysis> readAnalyses(const std::vector<Node>& tables, const plan::StudyPlan& plan,
                                         const std::vector<std::string>& staircases, Errors& errors);

}  // namespace passung::protocol
