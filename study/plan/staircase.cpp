#include "study/plan/staircase.h"

#include <algorithm>

#include "core/base/assert.h"
#include "study/plan/study_plan.h"

namespace passung::plan {

std::size_t Staircase::trials() const {
    std::size_t count = catch_trials;
    for (const StaircaseTrack& track : tracks) count += static_cast<std::size_t>(track.params.max_trials);
    return count;
}

const Staircase* staircaseOf(const StudyPlan& plan, std::size_t block) {
    const auto found = std::find_if(plan.staircases.begin(), plan.staircases.end(),
                                    [&](const Staircase& staircase) { return staircase.block == block; });
    return found == plan.staircases.end() ? nullptr : &*found;
}

std::size_t variantOf(const StudyPlan& plan, const Staircase& staircase, std::size_t condition, std::size_t level) {
    const Block& block = plan.blocks[staircase.block];
    std::size_t own = condition - block.first_condition;
    if (block.first_condition == 0 && !block.conditions.empty())
        own = static_cast<std::size_t>(std::find(block.conditions.begin(), block.conditions.end(), condition) -
                                       block.conditions.begin());
    PASSUNG_ASSERT(own < staircase.first_variant.size() && level < staircase.levels.size());
    return staircase.first_variant[own] + level;
}

}  // namespace passung::plan
