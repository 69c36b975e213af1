#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "analysis/export/study_data.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// What every virtual study is given on top of its own data: in all attempts of one level of a factor the measure is
/// multiplied, then shifted. That level is compared with another one. Persons differ in both.
struct PlantedEffect {
    std::string factor;
    std::string level;
    std::string against;  // the other level
    std::string measure;
    double scale = 1.0;
    double shift = 0.0;  // in the measure's unit
    // Standard deviations between persons.
    double log_scale_spread = 0.0;  // of the scale's logarithm
    double shift_spread = 0.0;
};

/// From "FACTOR:LEVEL=DELTA~SPREAD": DELTA is "+0.3" or "-0.3", added, or "x1.2", multiplied; without "~SPREAD" it is
/// the same for everybody. Without `against` the level is compared with the factor's first other one. An error names
/// what the plan does not have.
Result<PlantedEffect> readEffect(const std::string& text, const std::string& against, const std::string& measure,
                                 const plan::StudyPlan& plan);

/// Of an effect that is only added, what it adds on average; from the text that readEffect takes.
std::optional<double> addedBy(const std::string& text);

/// Whether the text says how persons differ in the effect.
bool saysSpread(const std::string& text);

/// Each person's own effect, normal around the planted one, follows from the code and `seed`, of that virtual study.
void plant(const PlantedEffect& effect, std::uint64_t seed, exporter::StudyData& study);

}  // namespace passung::power
