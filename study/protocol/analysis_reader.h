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

/// Tells whether a table of `exclude` is a rule on recorded values, no combination of levels.
bool isDataRule(const Node& table);
/// Reads those of `exclude` that are.
std::vector<plan::DataRule> readDataRules(const std::vector<Node>& tables, const plan::StudyPlan& plan, Errors& errors);

/// What is wrong with the scales that analyses and rules name, once the questionnaires are loaded.
Errors checkScales(const plan::StudyPlan& plan, const std::vector<plan::PlannedQuestionnaire>& questionnaires);

}  // namespace passung::protocol
