#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/power/effect_test.h"

namespace passung::power {

/// Whether R computes the test, as it does in a report: mixed models (lmm), proportional hazards (survival), two
/// one-sided t-tests (equivalence), and every interaction, a term of an analysis of variance or of a mixed model.
bool testedInR(const PlantedEffect& effect, const std::string& test);

/// Why R cannot compute it: what the plan or this machine lacks; empty: it can.
std::string whyNotInR(const PlantedEffect& effect, const std::string& test, const plan::StudyPlan& plan);

/// The tests of virtual studies in one run of R. Models have the factors of the planned analysis if that is of this
/// test, else the effect's alone; covariates are left out. Who counts: as in a report whoever has a value at each
/// combination of the factors within persons. `p` of an analysis of variance: Greenhouse and Geisser's; of equivalence:
/// the larger of two, small where the plan's first level less its second is proven to lie within the bounds. `mean` of
/// survival: the logarithm of the ratio of hazards.
Result<std::vector<EffectTest>> testInR(const PlantedEffect& effect, const std::string& test,
                                        const plan::StudyPlan& plan, std::span<const exporter::StudyData> studies);

}  // namespace passung::power
