#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/model/scene.h"
#include "study/protocol/study_plan.h"

namespace passung::app {

/// A stage of a scene's tick and what it costs here.
struct StageCost {
    std::string name;
    std::string reason;
    double median_us = 0.0;
    double p99_us = 0.0;
};

/// Measures every stage on this machine while the held part is pressed two millimetres into the nearest obstacle and
/// slides on it: 2 000 ticks in contact, or free ones if the scene has no obstacle.
std::vector<StageCost> measureStages(const model::Scene& scene);

/// Conditions that agree in everything that decides which stages run and what they cost; as the plan lists their first.
std::vector<std::vector<const protocol::Condition*>> costGroups(const protocol::StudyPlan& plan);

}  // namespace passung::app
