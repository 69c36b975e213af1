#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "core/base/result.h"
#include "study/plan/study_plan.h"

namespace passung::power {

/// A level of a factor and the one that it is compared with.
struct LevelPair {
    std::string factor;
    std::string level;
    std::string against;
};

/// What every virtual study is given on top of its own data: in all attempts of one level of a factor the measure is
/// multiplied, then shifted. Of an interaction: in those of one level of each of two factors. Persons differ in both.
struct PlantedEffect {
    std::vector<LevelPair> at;  // one factor, or the two of an interaction
    std::string measure;
    double scale = 1.0;
    double shift = 0.0;  // in the measure's unit
    // Standard deviations between persons.
    double log_scale_spread = 0.0;  // of the scale's logarithm
    double shift_spread = 0.0;
};

/// From "FACTOR:LEVEL=DELTA~SPREAD", or of an interaction "FACTOR:LEVEL*FACTOR:LEVEL=DELTA~SPREAD": DELTA is "+0.3" or
/// "-0.3", added, or "x1.2", multiplied; without "~SPREAD" it is the same for everybody. Without `against` the first
/// level is compared with its factor's first other one, as the second always is. An error names what the plan does not
/// have.
Result<PlantedEffect> readEffect(const std::string& text, const std::string& against, const std::string& measure,
                                 const plan::StudyPlan& plan);

/// Of an effect that is only added, what it adds on average; from the text that readEffect takes.
std::optional<double> addedBy(const std::string& text);

/// Whether the text says how persons differ in the effect.
bool saysSpread(const std::string& text);

/// Each person's own effect, normal around the planted one, follows from the code and `seed`, of that virtual study.
/// Of times: whatever then is above its condition's time-out has timed out, and what had timed out stays so.
void plant(const PlantedEffect& effect, std::uint64_t seed, exporter::StudyData& study);

}  // namespace passung::power
