#pragma once

#include "study/plan/study_plan.h"

namespace passung::power::test {

/// Gives the plan a condition for each combination of its two factors' levels.
inline void crossLevels(plan::StudyPlan& plan) {
    plan.conditions.clear();
    for (std::size_t one = 0; one < plan.factors[0].levels.size(); ++one) {
        for (std::size_t two = 0; two < plan.factors[1].levels.size(); ++two) {
            plan::Condition condition;
            condition.levels = {one, two};
            condition.name = plan.factors[0].levels[one].label + '/' + plan.factors[1].levels[two].label;
            plan.conditions.push_back(condition);
        }
    }
}

/// Two factors, three by two levels; a Williams order, twice, after a practice trial. No scene: for the model.
inline plan::StudyPlan smallPlan() {
    plan::StudyPlan plan;
    plan.name = "small";
    plan.version = "1.0";
    plan.seed = 11;
    plan.participants = 12;
    plan.source_text = "[study]";
    plan.factors = {{"method", plan::FactorKind::Within, "", {{"a"}, {"b=c"}, {"d"}}},
                    {"size", plan::FactorKind::Within, "mm", {{"1"}, {"2"}}}};
    plan.measures = {"completion_time_s", "peak_force_N"};
    crossLevels(plan);
    plan::Block practice, main;
    practice.name = "practice";
    practice.phase = plan::Phase::Practice;
    practice.order = plan::BlockOrder::Random;
    practice.trials = 1;
    main.name = "main";
    main.repetitions = 2;
    plan.blocks = {practice, main};
    return plan;
}

}  // namespace passung::power::test
