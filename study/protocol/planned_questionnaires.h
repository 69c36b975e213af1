#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// Reads a study's [[questionnaire]] tables; their files are not opened.
std::vector<plan::PlannedQuestionnaire> readQuestionnaires(const std::vector<Node>& tables,
                                                           const std::vector<plan::Block>& blocks, Errors& errors);

/// What is wrong with these files.
Errors checkQuestionnaires(const plan::StudyPlan& plan,
                           const std::function<Result<std::string>(const std::string&)>& read);

/// Reads the files that the plan's questionnaires name, relative to the plan's own, and checks them, in
/// every language that they are asked in; the plan's expanded JSON then holds their texts. `read` gives a file's bytes
/// by its path. A plan with an error in it stays as it was.
/// `language`: of a session, in which they are then, templates with texts in another one left out; empty: the
/// protocol's.
Result<Done> loadQuestionnaires(plan::StudyPlan& plan,
                                const std::function<Result<std::string>(const std::string&)>& read,
                                const std::string& language = {});

}  // namespace passung::protocol
