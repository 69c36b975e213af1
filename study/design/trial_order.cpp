#include "study/design/trial_order.h"

#include <algorithm>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "study/design/williams.h"

namespace passung::design {
namespace {

std::vector<std::size_t> countingUp(std::size_t n) {
    std::vector<std::size_t> items(n);
    std::iota(items.begin(), items.end(), std::size_t{0});
    return items;
}

std::vector<std::size_t> williamsRow(std::size_t conditions, const SessionKey& key) {
    const auto labels = conditionLabels(conditions, key.study, key.seed);
    auto row = williamsSquare(conditions)[key.slot % williamsRows(conditions)];
    for (auto& entry : row) entry = labels[entry];
    return row;
}

}  // namespace

std::vector<std::size_t> conditionLabels(std::size_t conditions, std::string_view study, std::uint64_t seed) {
    Random random(streamSeed(study, "", "", "relabel", seed));
    auto labels = countingUp(conditions);
    shuffle(labels, random);
    return labels;
}

std::vector<PlannedTrial> planSession(std::size_t conditions, const std::vector<BlockPlan>& blocks,
                                      const SessionKey& key) {
    PASSUNG_ASSERT(conditions >= 1);
    std::vector<PlannedTrial> trials;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const BlockPlan& block = blocks[b];
        Random random(streamSeed(key.study, key.participant, block.name, "trial_order", key.seed));
        auto pass = block.order == Order::Williams ? williamsRow(conditions, key) : countingUp(conditions);
        const std::size_t length = block.trials == 0 ? conditions : std::min(block.trials, conditions);
        std::int64_t trial_in_block = 0;
        for (int repetition = 1; repetition <= block.repetitions; ++repetition) {
            if (block.order == Order::Random) {
                pass = countingUp(conditions);
                shuffle(pass, random);
            }
            for (std::size_t i = 0; i < length; ++i)
                trials.push_back({static_cast<std::int64_t>(trials.size()), static_cast<std::int64_t>(b), block.name,
                                  trial_in_block++, block.phase, pass[i], repetition});
        }
    }
    return trials;
}

}  // namespace passung::design
