#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene.h"
#include "study/plan/study_plan.h"

namespace passung::run {

/// A stage of a scene's tick and what it costs here.
struct StageCost {
    std::string name;
    std::string reason;
    double median_us = 0.0;
    double p99_us = 0.0;
};

/// What a tick of a scene costs here, in processor time: other programs do not count.
struct TickCost {
    std::vector<StageCost> stages;
    double median_us = 0.0, p99_us = 0.0, most_us = 0.0;  // of all stages together
    int ticks = 0;                                        // that were counted
    bool in_contact = false;                              // only ticks in contact were; else free ones
    // Of scenes whose proxy looks at fields or surfaces; 0: nothing is capped
    std::uint32_t work_cap = 0;   // units of work that a tick's looks may take
    std::uint32_t most_work = 0;  // that one took here
    double at_cap_us = 0.0;       // what a tick would take that takes all of it: by the line through these ticks

    static constexpr int kRuns = 3;            // a tick's time is the least of so many equal runs
    static constexpr int kWantedTicks = 2000;  // of contact
    /// Tells whether 99 of a hundred ticks take less than the millisecond that they have.
    bool fits() const { return p99_us < 1000.0; }
};

/// Measures every stage on this machine while the held part is pressed two millimetres into the nearest obstacle and
/// slides on it, until kWantedTicks of contact are counted, or many more without; free ticks if the scene has no
/// obstacle.
TickCost measureTick(const scene::Scene& scene);

/// Conditions that agree in everything that decides which stages run and what they cost; as the plan lists their first.
std::vector<std::vector<const plan::Condition*>> costGroups(const plan::StudyPlan& plan);

}  // namespace passung::run
