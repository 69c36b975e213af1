#pragma once

#include <string>

#include "study/plan/study_plan.h"

namespace passung::protocol {

/// Everything of a condition that somebody can feel, see or hear, or that judges the trial, as text. Names of parts are
/// none of it, nor is feedback that the condition says but that has no effect in it.
std::string whatReaches(plan::Condition condition);

/// Why what two conditions say of feedback or weight makes no difference where they reach people alike; empty if they
/// say the same.
std::string deadFeedback(const plan::Condition& a, const plan::Condition& b);

}  // namespace passung::protocol
