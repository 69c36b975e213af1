#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "study/session/questionnaire_source.h"

namespace passung::session {

/// What is asked between two trials, in this order: after the trial, its condition, its block, at the session's end or
/// start, before the block; those of one moment as the plan lists them. `before`: the trial that was over last in this
/// run of the session, nullptr if none was. `to_do`: all that are still to do, the next one first. A condition or block
/// ends when none of its trials is left to do.
std::vector<Occasion> occasionsBetween(const plan::StudyPlan& plan, const design::PlannedTrial* before,
                                       std::span<const design::PlannedTrial> to_do);

/// Those whose answers are about the trial: it, its condition and block, and the session up to its end.
std::vector<Occasion> occasionsAbout(const plan::StudyPlan& plan, const design::PlannedTrial& trial);

/// Tells whether a form of this occasion asks about the trial.
bool isAbout(const plan::StudyPlan& plan, const Occasion& occasion, const design::PlannedTrial& trial);

}  // namespace passung::session
