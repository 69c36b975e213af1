#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/protocol/study_plan.h"

namespace passung::protocol {

/// Languages that a participant of the study may be spoken to in: those of its texts, else of its clauses of consent,
/// else of its questionnaires; a study without any of these is in English.
std::vector<std::string> languagesOf(const StudyPlan& plan);

/// `asked`, or (empty) the first of languagesOf(). Errors: it is none of them.
Result<std::string> chooseLanguage(const StudyPlan& plan, const std::string& asked);

}  // namespace passung::protocol
