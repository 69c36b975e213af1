#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "analysis/power/planted_effect.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// Names of the tests of an effect, as a protocol's [[analysis]] has them.
std::vector<std::string> testNames();

/// The test for an effect of this factor, or of these two: `asked`, or (empty) that of the plan's first analysis of the
/// measure by them, or paired_t or welch_t, of an interaction rm_anova or mixed_anova. An error says why the test does
/// not suit, or what R lacks for it.
Result<std::string> chooseTest(const std::string& asked, const PlantedEffect& effect, const plan::StudyPlan& plan);

/// What a virtual study says.
struct EffectTest {
    std::size_t n = 0;       // participants that enter
    double mean = kNothing;  // difference between the two levels; of an interaction the difference of two such
    double sd = kNothing;    // of a participant's difference; between groups there is none
    double statistic = kNothing;
    double p = kNothing;

    static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
};

/// The tests of virtual studies, each by itself. A participant's value at a level is the mean of their cells' values
/// there; cells and values are those of the exports, of the block that the planned analysis names. paired_t, wilcoxon,
/// welch_t and mann_whitney compare the effect's two levels; rm_anova, friedman and mixed_anova test the factor's main
/// effect over all its levels, mixed_anova in the groups that all between factors make. Whoever has no value at one of
/// these levels is left out.
///   What r_tests.h names is computed by R: an error says what R said.
Result<std::vector<EffectTest>> testEffect(const PlantedEffect& effect, const std::string& test,
                                           const plan::StudyPlan& plan, std::span<const exporter::StudyData> studies);

/// How many virtual studies are best tested in one call.
std::size_t studiesAtOnce(const PlantedEffect& effect, const std::string& test);

}  // namespace passung::power
