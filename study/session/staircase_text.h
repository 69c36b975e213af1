#pragma once

#include <string>

#include "study/plan/study_plan.h"

namespace passung::session {

/// The plan's staircases for an experimenter to read: what varies, by which rule, where it settles, how many trials;
/// empty if there is none.
std::string staircasesText(const plan::StudyPlan& plan);

/// Tells whether a session may need fewer trials than are planned.
bool mayEndEarly(const plan::StudyPlan& plan);

}  // namespace passung::session
