#pragma once

#include <string>

#include "study/plan/study_plan.h"

namespace passung::report {

/// What a protocol plans, as Markdown that answers AsPredicted's questions, as far as a protocol can: hypotheses are
/// left to whoever registers it.
std::string preregistrationOf(const plan::StudyPlan& plan);

}  // namespace passung::report
