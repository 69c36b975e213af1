#pragma once

#include <string>
#include <string_view>

#include "analysis/power/planted_effect.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// Null: the plan has none of that name.
const plan::Factor* factorNamed(std::string_view name, const plan::StudyPlan& plan);

/// The plan's factor that the pair is of. @pre there is one
const plan::Factor& factorOf(const LevelPair& pair, const plan::StudyPlan& plan);

/// The plan's first analysis of the effect's measure by its factor, of an interaction by both; null: there is none.
const plan::Analysis* plannedAnalysis(const PlantedEffect& effect, const plan::StudyPlan& plan);

/// The block whose trials that analysis takes; empty: all.
std::string plannedBlock(const PlantedEffect& effect, const plan::StudyPlan& plan);

/// Whether that analysis is of logarithms.
bool plansLogarithm(const PlantedEffect& effect, const plan::StudyPlan& plan);

}  // namespace passung::power
