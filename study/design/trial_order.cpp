#include "study/design/trial_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "study/design/block_pools.h"
#include "study/design/permutations.h"
#include "study/design/williams.h"

namespace passung::design {
namespace {

/// The row of pass `pass` (from 0) for whoever has row `row` in the first one: another row in every pass as long as
/// there are any, so that nobody gets an order twice. In each pass the rows of all people are one rotation of those
/// they had, which keeps the balance.
///
/// Even n: row r + pass of n. Its first entry is r + pass, the last one of the row before r + pass - 1 + n/2: equal
/// only for n = 2. Odd n: forward in the first n rows, which end with r + (n + 1)/2, backward in the reversed ones,
/// which begin with r + (n + 1)/2 and end with r; after n passes the other half. No condition follows itself inside a
/// half.
std::size_t rowOfPass(const CounterbalancingFactor& balancing, std::size_t row, std::size_t pass) {
    const std::size_t n = balancing.items, rows = rowsOf(balancing);
    if (balancing.order != Order::Williams || rows == n) return (row + pass) % rows;
    const std::size_t half = (row / n + pass / n) % 2, step = pass % n;
    return half * n + (row % n + (half == 0 ? step : n - step)) % n;
}

/// Row of a counterbalanced counterbalancing factor in a pass as numbers 0 … items-1.
std::vector<std::size_t> turnOf(const Design& design, const CounterbalancingFactor& balancing, const SessionKey& key,
                                std::size_t pass) {
    const auto balancings = counterbalancingFactorsOf(design);
    const auto which =
        static_cast<std::size_t>(std::find(balancings.begin(), balancings.end(), balancing) - balancings.begin());
    PASSUNG_ASSERT(which < balancings.size());
    const std::size_t row = rowOfPass(balancing, rowOf(balancings, which, key.slot), pass);
    if (balancing.items < 2) return std::vector<std::size_t>(balancing.items, 0);
    if (balancing.order == Order::Permutations) return permutation(balancing.items, row);
    const auto phase =
        balancing.what == CounterbalancingFactor::What::Levels ? design.factors[*balancing.factor].name : std::string();
    const auto labels = relabelling(balancing.items, key.study, phase, key.seed);
    auto turn = williamsSquare(balancing.items)[row];
    for (auto& entry : turn) entry = labels[entry];
    return turn;
}

/// 0 … items-1 in the order of the counterbalancing factor in a pass, from 0; of other orders as listed.
std::vector<std::size_t> arrange(const Design& design, const CounterbalancingFactor& balancing, const SessionKey& key,
                                 std::size_t pass = 0) {
    if (isCounterbalanced(balancing.order)) return turnOf(design, balancing, key, pass);
    std::vector<std::size_t> listed(balancing.items);
    std::iota(listed.begin(), listed.end(), std::size_t{0});
    return listed;
}

/// Puts the pool's catch trials among its others: their places are drawn, then who stands there.
void insertCatches(const CatchPlan& plan, std::vector<std::size_t> catches, Random& random, BlockPool& pool) {
    if (plan.trials == 0) return;
    std::vector<std::size_t> places(pool.items.size() + plan.trials);
    std::iota(places.begin(), places.end(), std::size_t{0});
    const std::size_t to = plan.to == 0 ? places.size() : std::min(plan.to, places.size());
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(to), places.end());
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(plan.from - 1));
    shuffle(places, random);
    places.resize(plan.trials);
    std::sort(places.begin(), places.end());
    shuffle(catches, random);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto at = static_cast<std::ptrdiff_t>(places[i]);
        pool.items.insert(pool.items.begin() + at, catches[i % catches.size()]);
    }
}

Error noOrder(const BlockPlan& block, std::string_view participant) {
    Error error;
    error.message = fmt::format("no order for participant {} keeps to all its constraints", participant);
    error.key = "block." + block.name;
    return error;
}

}  // namespace

std::vector<BlockPool> poolsOf(const Design& design, const BlockPlan& block, const SessionKey& key) {
    const Cells cells = cellsOf(block, cellsOf(design, key.group, key.slot, key.study, key.seed));
    const auto parts = partedBy(design, block.blocked, cells.ordinary);
    const auto catch_parts = partedBy(design, block.blocked, cells.catches);
    std::vector<std::size_t> levels{0};
    if (block.blocked)
        levels = arrange(design,
                         {CounterbalancingFactor::What::Levels, block.blocked, block.blocked_order, parts.size()}, key);
    if (block.blocked && block.blocked_order == Order::Random) {
        Random random(streamSeed(key.study, key.participant, block.name, "blocked_order", key.seed));
        shuffle(levels, random);
    }
    std::vector<BlockPool> pools;
    for (const std::size_t level : levels) {
        const auto& part = parts[level];
        const auto passOf = [&](int repetition) {
            std::vector<std::size_t> pass;
            for (const std::size_t i :
                 arrange(design, {CounterbalancingFactor::What::Conditions, block.blocked, block.order, part.size()},
                         key, static_cast<std::size_t>(repetition - 1)))
                pass.push_back(part[i]);
            return pass;
        };
        const auto& catches = catch_parts.empty() ? part : catch_parts[std::min(level, catch_parts.size() - 1)];
        if (block.order != Order::Shuffled) {
            for (int r = 1; r <= block.repetitions; ++r) pools.push_back({passOf(r), catches, r});
            continue;
        }
        BlockPool all{{}, catches, 1};
        const auto pass = passOf(1);
        for (int r = 0; r < block.repetitions; ++r) all.items.insert(all.items.end(), pass.begin(), pass.end());
        pools.push_back(std::move(all));
    }
    return pools;
}

std::vector<ItemRule> rulesOf(const Design& design, const BlockPlan& block) {
    std::vector<ItemRule> rules;
    for (const Constraint& constraint : block.constraints) {
        ItemRule rule{constraint, {}};
        for (std::size_t c = 0; c < design.conditions.size(); ++c)
            rule.class_of.push_back(constraint.factor ? design.conditions[c].levels[*constraint.factor] : c);
        rules.push_back(std::move(rule));
    }
    return rules;
}

Pools itemsOf(const std::vector<BlockPool>& pools) {
    Pools items;
    for (const BlockPool& pool : pools) items.push_back(pool.items);
    return items;
}

namespace {

/// Shuffles the pools of a random block, keeping to its constraints; false if that cannot be done.
bool randomise(const Design& design, const BlockPlan& block, const SessionKey& key, std::vector<BlockPool>& pools) {
    if (block.order != Order::Random && block.order != Order::Shuffled) return true;
    Random random(streamSeed(key.study, key.participant, block.name, "trial_order", key.seed));
    if (block.constraints.empty()) {
        for (BlockPool& pool : pools) shuffle(pool.items, random);
        return true;
    }
    const auto order = constrainedOrder(itemsOf(pools), rulesOf(design, block), random);
    if (!order) return false;
    for (std::size_t i = 0; i < pools.size(); ++i) pools[i].items = order->pools[i];
    return true;
}

}  // namespace

Result<std::vector<PlannedTrial>> planSession(const Design& design, const SessionKey& key) {
    PASSUNG_ASSERT(!design.conditions.empty());
    std::vector<PlannedTrial> trials;
    for (std::size_t b = 0; b < design.blocks.size(); ++b) {
        const BlockPlan& block = design.blocks[b];
        if (block.session != key.session) continue;
        auto pools = poolsOf(design, block, key);
        if (!randomise(design, block, key, pools)) return noOrder(block, key.participant);
        Random random(streamSeed(key.study, key.participant, block.name, "catch", key.seed));
        std::int64_t trial_in_block = 0;
        std::map<std::size_t, int> seen;
        for (BlockPool& pool : pools) {
            if (block.trials > 0) pool.items.resize(std::min(block.trials, pool.items.size()));
            insertCatches(block.catches, pool.catches, random, pool);
            for (const std::size_t condition : pool.items)
                trials.push_back({static_cast<std::int64_t>(trials.size()), static_cast<std::int64_t>(b), block.name,
                                  trial_in_block++, design.conditions[condition].catch_trial ? "catch" : block.phase,
                                  numberIn(block, condition),
                                  block.order == Order::Shuffled ? ++seen[condition] : pool.repetition});
        }
    }
    return trials;
}

double acceptanceOf(const Design& design, std::size_t block) {
    const BlockPlan& plan = design.blocks[block];
    Random random(streamSeed("", "", plan.name, "acceptance", 0));
    return acceptedShare(itemsOf(poolsOf(design, plan, {})), rulesOf(design, plan), random, 1000);
}

}  // namespace passung::design
