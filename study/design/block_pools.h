#pragma once

#include <cstddef>
#include <vector>

#include "study/design/trial_order.h"

namespace passung::design {

/// Trials of a block that may change places: a pass, or in a Shuffled block all passes; of a blocked one per level.
struct BlockPool {
    std::vector<std::size_t> items;    // conditions
    std::vector<std::size_t> catches;  // conditions that its catch trials may have
    int repetition = 1;
};

/// The pools of a block in the order in which they run, before anything is drawn but a Random order of levels.
std::vector<BlockPool> poolsOf(const Design& design, const BlockPlan& block, const SessionKey& key);

/// The block's constraints with the class of every condition.
std::vector<ItemRule> rulesOf(const Design& design, const BlockPlan& block);

Pools itemsOf(const std::vector<BlockPool>& pools);

}  // namespace passung::design
