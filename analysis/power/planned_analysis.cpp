#include "analysis/power/planned_analysis.h"

#include <algorithm>

namespace passung::power {

const plan::Factor* factorNamed(std::string_view name, const plan::StudyPlan& plan) {
    const auto found = std::find_if(plan.factors.begin(), plan.factors.end(),
                                    [&](const plan::Factor& factor) { return factor.name == name; });
    return found == plan.factors.end() ? nullptr : &*found;
}

const plan::Factor& factorOf(const LevelPair& pair, const plan::StudyPlan& plan) {
    return *factorNamed(pair.factor, plan);
}

const plan::Analysis* plannedAnalysis(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const auto isOf = [](const plan::Analysis& analysis, const LevelPair& pair) {
        return std::find(analysis.factors.begin(), analysis.factors.end(), pair.factor) != analysis.factors.end();
    };
    const auto found = std::find_if(plan.analyses.begin(), plan.analyses.end(), [&](const plan::Analysis& analysis) {
        return analysis.outcome == effect.measure &&
               std::all_of(effect.at.begin(), effect.at.end(),
                           [&](const LevelPair& pair) { return isOf(analysis, pair); });
    });
    return found == plan.analyses.end() ? nullptr : &*found;
}

std::string plannedBlock(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const plan::Analysis* analysis = plannedAnalysis(effect, plan);
    return analysis != nullptr ? analysis->block : "";
}

bool plansLogarithm(const PlantedEffect& effect, const plan::StudyPlan& plan) {
    const plan::Analysis* analysis = plannedAnalysis(effect, plan);
    return analysis != nullptr && analysis->transform == "log";
}

}  // namespace passung::power
