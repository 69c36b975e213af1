#include "study/design/design.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "study/design/permutations.h"
#include "study/design/williams.h"

namespace passung::design {
namespace {

std::vector<std::size_t> levelsOf(const Design& design, const ConditionPlan& condition, FactorKind kind) {
    std::vector<std::size_t> levels;
    for (std::size_t f = 0; f < design.factors.size(); ++f)
        if (design.factors[f].kind == kind) levels.push_back(condition.levels[f]);
    return levels;
}

/// Combinations of within levels that the group sees, in the order of the conditions; of a block: those that it has.
std::vector<std::vector<std::size_t>> withinCells(const Design& design, const std::vector<std::size_t>& group,
                                                  bool catches, const BlockPlan* block = nullptr) {
    std::vector<std::vector<std::size_t>> cells;
    std::set<std::vector<std::size_t>> seen;
    for (std::size_t c = 0; c < design.conditions.size(); ++c) {
        const ConditionPlan& condition = design.conditions[c];
        if (condition.catch_trial != catches || levelsOf(design, condition, FactorKind::Between) != group) continue;
        if (block != nullptr && !hasCondition(*block, c)) continue;
        auto levels = levelsOf(design, condition, FactorKind::Within);
        if (seen.insert(levels).second) cells.push_back(std::move(levels));
    }
    return cells;
}

}  // namespace

bool hasCondition(const BlockPlan& block, std::size_t condition) {
    return block.conditions.empty() ||
           std::find(block.conditions.begin(), block.conditions.end(), condition) != block.conditions.end();
}

std::size_t numberIn(const BlockPlan& block, std::size_t condition) {
    if (block.first_condition == 0 || block.conditions.empty()) return block.first_condition + condition;
    const auto place = std::find(block.conditions.begin(), block.conditions.end(), condition);
    PASSUNG_ASSERT(place != block.conditions.end());
    return block.first_condition + static_cast<std::size_t>(place - block.conditions.begin());
}

Cells cellsOf(const BlockPlan& block, const Cells& cells) {
    if (block.conditions.empty()) return cells;
    Cells chosen;
    for (const std::size_t condition : block.conditions) {
        const auto isIn = [&](const auto& list) {
            return std::find(list.begin(), list.end(), condition) != list.end();
        };
        if (isIn(cells.ordinary)) chosen.ordinary.push_back(condition);
        if (isIn(cells.catches)) chosen.catches.push_back(condition);
    }
    return chosen;
}

std::size_t rowsOf(const CounterbalancingFactor& balancing) {
    if (balancing.items < 2) return 1;
    if (balancing.what == CounterbalancingFactor::What::Assignment) return balancing.items;
    return balancing.order == Order::Williams ? williamsRows(balancing.items) : permutationCount(balancing.items);
}

std::vector<CounterbalancingFactor> counterbalancingFactorsOf(const Design& design) {
    std::vector<CounterbalancingFactor> balancings;
    const auto add = [&](const CounterbalancingFactor& balancing) {
        if (std::find(balancings.begin(), balancings.end(), balancing) == balancings.end())
            balancings.push_back(balancing);
    };
    if (design.conditions.empty()) return balancings;
    // Every group sees equally many; which conditions these are does not depend on the slot.
    const auto group = groupsOf(design).front();
    for (const BlockPlan& block : design.blocks) {
        std::map<std::size_t, std::size_t> parts;  // level, conditions
        for (std::size_t c = 0; c < design.conditions.size(); ++c) {
            const ConditionPlan& condition = design.conditions[c];
            if (condition.catch_trial || levelsOf(design, condition, FactorKind::Between) != group) continue;
            if (block.blocked && hasCondition(block, c)) parts[condition.levels[*block.blocked]] = 0;
        }
        const std::size_t cells = withinCells(design, group, false, &block).size();
        if (block.blocked && isCounterbalanced(block.blocked_order))
            add({CounterbalancingFactor::What::Levels, block.blocked, block.blocked_order, parts.size()});
        if (isCounterbalanced(block.order))
            add({CounterbalancingFactor::What::Conditions, block.blocked, block.order,
                 block.blocked && !parts.empty() ? cells / parts.size() : cells});
    }
    for (std::size_t f = 0; f < design.factors.size(); ++f)
        if (design.factors[f].kind == FactorKind::Nuisance)
            add({CounterbalancingFactor::What::Assignment, f, Order::Listed, design.factors[f].levels});
    return balancings;
}

std::size_t sequencesOf(const Design& design) {
    std::size_t product = 1;
    for (const CounterbalancingFactor& balancing : counterbalancingFactorsOf(design)) product *= rowsOf(balancing);
    return product;
}

std::size_t rowOf(const std::vector<CounterbalancingFactor>& balancings, std::size_t which, std::size_t slot) {
    for (std::size_t i = 0; i < which; ++i) slot /= rowsOf(balancings[i]);
    return slot % rowsOf(balancings[which]);
}

std::vector<std::vector<std::size_t>> groupsOf(const Design& design) {
    std::vector<std::vector<std::size_t>> groups;
    for (const ConditionPlan& condition : design.conditions) {
        auto levels = levelsOf(design, condition, FactorKind::Between);
        if (std::find(groups.begin(), groups.end(), levels) == groups.end()) groups.push_back(std::move(levels));
    }
    if (groups.empty()) groups.emplace_back();
    return groups;
}

std::vector<std::size_t> relabelling(std::size_t items, std::string_view study, std::string_view phase,
                                     std::uint64_t seed) {
    Random random(streamSeed(study, "", phase, "relabel", seed));
    std::vector<std::size_t> labels(items);
    std::iota(labels.begin(), labels.end(), std::size_t{0});
    shuffle(labels, random);
    return labels;
}

Cells cellsOf(const Design& design, std::size_t group, std::size_t slot, std::string_view study, std::uint64_t seed) {
    const auto groups = groupsOf(design);
    PASSUNG_ASSERT(group < groups.size());
    const auto balancings = counterbalancingFactorsOf(design);
    struct Assignment {
        std::vector<std::size_t> labels;
        std::size_t row;
    };
    std::vector<Assignment> assignments;  // one per nuisance factor
    for (std::size_t w = 0; w < balancings.size(); ++w)
        if (balancings[w].what == CounterbalancingFactor::What::Assignment)
            assignments.push_back(
                {relabelling(balancings[w].items, study, design.factors[*balancings[w].factor].name, seed),
                 rowOf(balancings, w, slot)});
    const auto choose = [&](bool catches) {
        std::vector<std::size_t> chosen;
        const auto cells = withinCells(design, groups[group], catches);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            std::vector<std::size_t> nuisance;
            for (const Assignment& a : assignments) nuisance.push_back(a.labels[(i + a.row) % a.labels.size()]);
            for (std::size_t c = 0; c < design.conditions.size(); ++c)
                if (levelsOf(design, design.conditions[c], FactorKind::Within) == cells[i] &&
                    levelsOf(design, design.conditions[c], FactorKind::Between) == groups[group] &&
                    levelsOf(design, design.conditions[c], FactorKind::Nuisance) == nuisance)
                    chosen.push_back(c);
        }
        return chosen;
    };
    return {choose(false), choose(true)};
}

std::vector<std::vector<std::size_t>> partedBy(const Design& design, std::optional<std::size_t> factor,
                                               const std::vector<std::size_t>& cells) {
    if (!factor) return {cells};
    std::map<std::size_t, std::vector<std::size_t>> parts;
    for (const std::size_t cell : cells) parts[design.conditions[cell].levels[*factor]].push_back(cell);
    std::vector<std::vector<std::size_t>> list;
    for (auto& [level, part] : parts) list.push_back(std::move(part));
    return list;
}

}  // namespace passung::design
