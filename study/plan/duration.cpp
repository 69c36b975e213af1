#include "study/plan/duration.h"

#include <algorithm>

namespace passung::plan {

double longestDuration(const StudyPlan& plan, std::span<const design::PlannedTrial> trials) {
    double seconds = 0.0;
    std::int64_t block = -1;
    for (const design::PlannedTrial& trial : trials) {
        seconds += plan.conditions[trial.condition].task.timeout;
        if (trial.block_index != block) seconds += plan.blocks[static_cast<std::size_t>(trial.block_index)].rest;
        block = trial.block_index;
    }
    return seconds;
}

double longestSession(const StudyPlan& plan) {
    const design::Design design = designOf(plan);
    double longest = 0.0;
    for (std::size_t group = 0; group < design::groupsOf(design).size(); ++group)
        for (int session = 1; session <= sessionsOf(plan); ++session)
            if (const auto trials = design::planSession(design, {plan.name, plan.seed, "", 0, group, session}))
                longest = std::max(longest, longestDuration(plan, *trials));
    return longest;
}

}  // namespace passung::plan
