#include "study/session/order_rows.h"

namespace passung::session {

std::vector<OrderedBlock> orderOf(const plan::StudyPlan& plan, const std::vector<design::PlannedTrial>& trials) {
    std::vector<OrderedBlock> blocks;
    for (std::size_t next = 0; next < trials.size();) {
        const auto index = trials[next].block_index;
        OrderedBlock block{static_cast<std::size_t>(index), {}};
        // A shuffled block is one pass: its repetitions are mixed.
        const bool one_pass = plan.blocks[block.block].order == plan::BlockOrder::Shuffled;
        while (next < trials.size() && trials[next].block_index == index) {
            const int repetition = trials[next].repetition;
            OrderedPass pass;
            for (; next < trials.size() && trials[next].block_index == index &&
                   (one_pass || trials[next].repetition == repetition);
                 ++next)
                pass.trials.push_back({trials[next].condition, trials[next].phase == "catch"});
            if (!block.passes.empty() && block.passes.back().trials == pass.trials)
                ++block.passes.back().times;
            else
                block.passes.push_back(std::move(pass));
        }
        blocks.push_back(std::move(block));
    }
    return blocks;
}

}  // namespace passung::session
