#pragma once

#include <vector>

#include "study/measures/trial.h"

namespace passung::measures {

// Measures that only one type of trial has: empty in all others. Their names stand in study/protocol/trial_types.h too.
std::vector<Measure> passageMeasures();
std::vector<Measure> contourMeasures();
std::vector<Measure> placementMeasures();
std::vector<Measure> pairMeasures();
std::vector<Measure> assemblyMeasures();

}  // namespace passung::measures
