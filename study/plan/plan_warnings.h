#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/plan/study_plan.h"

namespace passung::plan {

/// Sentences about what conditions allow and an experimenter should know, each with their names.
std::vector<std::string> conditionWarnings(std::span<const Condition> conditions);

/// Sentences about cues that nothing here can give a person, each with the names of the conditions that have it; part
/// of conditionWarnings(). Not empty: people and pilots cannot take part.
std::vector<std::string> cuesWithoutOutput(std::span<const Condition> conditions);

/// Tells whether everything that the plan's cues ask for can be given to a person here.
bool isForPeople(const StudyPlan& plan);

/// Such sentences about main blocks. One that a staircase governs repeats what its tracks lack anyway.
/// `chosen_measures`: the protocol lists its measures itself.
std::vector<std::string> blockWarnings(const StudyPlan& plan, bool chosen_measures);

/// Such sentences about staircases whose thresholds are to be analysed.
std::vector<std::string> thresholdWarnings(const StudyPlan& plan);

}  // namespace passung::plan
