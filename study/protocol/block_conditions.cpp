#include "study/protocol/block_conditions.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/protocol/block_reader.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {
namespace {

/// Chooses for one block.
class Chooser {
public:
    Chooser(const std::vector<plan::Factor>& factors, const plan::StudyPlan& plan, const plan::Block& block,
            Errors& errors)
        : factors_(factors),
          plan_(plan),
          block_(block),
          path_("block." + block.name + ".conditions"),
          errors_(errors) {}

    std::vector<std::size_t> choose(const Node& list) {
        if (list.items.empty()) report(list, "names no condition");
        for (const Node& item : list.items) {
            const std::size_t before = errors_.size();
            const auto found = find(item);
            if (errors_.size() > before) continue;
            if (found.empty()) report(item, "the study has no condition with these levels");
            for (const std::size_t c : found) add(item, c);
        }
        if (!list.items.empty() && chosen_.empty()) return chosen_;
        checkNuisance(list);
        const bool lists_catches = std::any_of(chosen_.begin(), chosen_.end(), [&](auto c) { return isCatch(c); });
        for (std::size_t c = 0; c < plan_.shared_conditions; ++c)
            if (block_.catches.trials > 0 && !lists_catches && isCatch(c)) chosen_.push_back(c);
        std::stable_partition(chosen_.begin(), chosen_.end(), [&](std::size_t c) { return !isCatch(c); });
        return chosen_;
    }

private:
    void report(const Node& node, std::string message) {
        errors_.push_back(errorAt(node.place, path_, valueText(node), std::move(message)));
    }

    bool isCatch(std::size_t condition) const {
        const auto& levels = plan_.conditions[condition].levels;
        for (std::size_t f = 0; f < levels.size(); ++f)
            if (factors_[f].levels[levels[f]].catch_trial) return true;
        return false;
    }

    std::vector<std::size_t> find(const Node& item) {
        std::vector<std::size_t> found;
        if (item.kind == Node::Kind::Table) {
            const LevelPattern pattern = readPattern(item, path_, factors_, errors_);
            for (std::size_t c = 0; c < plan_.shared_conditions; ++c)
                if (matches(pattern, plan_.conditions[c].levels)) found.push_back(c);
            // Whoever names a level of ordinary trials does not mean the catch trials that share it.
            if (std::any_of(found.begin(), found.end(), [&](auto c) { return !isCatch(c); }))
                std::erase_if(found, [&](auto c) { return isCatch(c); });
            return found;
        }
        if (item.kind != Node::Kind::Text) {
            report(item, "must be a condition's name, or a table of levels such as { method = \"penalty\" }");
            return found;
        }
        std::vector<std::string_view> names;
        for (std::size_t c = 0; c < plan_.shared_conditions; ++c) {
            names.push_back(plan_.conditions[c].name);
            if (plan_.conditions[c].name == item.text) found.push_back(c);
        }
        if (!found.empty()) return found;
        const auto close = closestWord(item.text, names);
        report(item,
               close ? fmt::format("the study has no condition of this name; did you mean \"{}\"?", *close)
                     : fmt::format("the study has no condition of this name; conditions: {}", fmt::join(names, ", ")));
        return found;
    }

    void add(const Node& item, std::size_t condition) {
        if (std::find(chosen_.begin(), chosen_.end(), condition) != chosen_.end())
            return report(item, fmt::format("condition {} is listed twice", plan_.conditions[condition].name));
        if (isCatch(condition) && block_.catches.trials == 0)
            return report(item, fmt::format("condition {} is of catch trials, and the block has no catch_trials",
                                            plan_.conditions[condition].name));
        chosen_.push_back(condition);
    }

    /// Everybody is assigned one level of a nuisance factor: a block with some of them would be another for everybody.
    void checkNuisance(const Node& list) {
        for (const std::size_t c : chosen_)
            for (std::size_t other = 0; other < plan_.shared_conditions; ++other) {
                if (std::find(chosen_.begin(), chosen_.end(), other) != chosen_.end()) continue;
                bool same = true;
                for (std::size_t f = 0; f < factors_.size(); ++f)
                    same = same && (factors_[f].kind == plan::FactorKind::Nuisance ||
                                    plan_.conditions[c].levels[f] == plan_.conditions[other].levels[f]);
                if (same)
                    return report(list, fmt::format("has {} but not {}: a nuisance factor's levels are assigned to "
                                                    "every condition",
                                                    plan_.conditions[c].name, plan_.conditions[other].name));
            }
    }

    const std::vector<plan::Factor>& factors_;
    const plan::StudyPlan& plan_;
    const plan::Block& block_;
    std::string path_;
    Errors& errors_;
    std::vector<std::size_t> chosen_;
};

}  // namespace

void chooseConditions(const std::vector<Node>& tables, const std::vector<plan::Factor>& factors, plan::StudyPlan& plan,
                      Errors& errors) {
    if (plan.shared_conditions == 0) return;
    for (std::size_t b = 0; b < plan.blocks.size() && b < tables.size(); ++b) {
        const Node* list = tables[b].find("conditions");
        if (list == nullptr || list->kind != Node::Kind::List) continue;
        plan::Block& block = plan.blocks[b];
        block.conditions = Chooser(factors, plan, block, errors).choose(*list);
    }
}

}  // namespace passung::protocol
