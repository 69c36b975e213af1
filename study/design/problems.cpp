#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "study/design/block_pools.h"
#include "study/design/counted.h"
#include "study/design/permutations.h"
#include "study/design/trial_order.h"

namespace passung::design {
namespace {

constexpr std::size_t kMaxSequences = 100'000;

/// Looks at one block; every finding goes to the list.
class BlockCheck {
public:
    BlockCheck(const Design& design, std::size_t number, std::vector<Problem>& problems)
        : design_(design), block_(design.blocks[number]), number_(number), problems_(problems) {}

    void check() {
        if (!checkParts()) return;
        checkSquares();
        checkCatches();
        checkConstraints();
    }

private:
    void report(const char* key, std::string message, std::size_t item = 0) {
        problems_.push_back({number_, key, item, std::move(message)});
    }

    bool chooses() const { return !block_.conditions.empty(); }

    /// Every group, and in it every level of a blocked factor, has equally many conditions.
    bool checkParts() {
        const std::size_t groups = groupsOf(design_).size();
        for (std::size_t group = 0; group < groups; ++group) {
            const auto cells = cellsOf(block_, cellsOf(design_, group, 0, "", 0));
            const auto parts = partedBy(design_, block_.blocked, cells.ordinary);
            if (parts.empty() || parts[0].empty()) {
                report(chooses() ? "conditions" : "order", chooses()
                                                               ? "leave a group without a condition"
                                                               : "there are no conditions but those of catch trials");
                return false;
            }
            if (group == 0) pass_ = parts[0].size(), levels_ = parts.size();
            const bool even = parts.size() == levels_ &&
                              std::all_of(parts.begin(), parts.end(), [&](const auto& p) { return p.size() == pass_; });
            if (even) continue;
            report(block_.blocked ? "blocked"
                   : chooses()    ? "conditions"
                                  : "order",
                   block_.blocked ? "the levels of this factor have different numbers of conditions"
                                  : "the groups see different numbers of conditions");
            return false;
        }
        return true;
    }

    void checkSquares() {
        const auto check = [&](const char* key, Order order, std::size_t items, const char* what) {
            // One condition that a block has chosen for itself is its own order.
            if (order == Order::Williams && items < 2 && !chooses())
                report(key, fmt::format("a Williams square needs at least two {}", what));
            if (order == Order::Permutations && items > kMaxPermuted)
                report(key, fmt::format("all orders of {} {} are too many; at most {}", items, what, kMaxPermuted));
        };
        check("order", block_.order, pass_, "conditions");
        if (block_.blocked) check("blocked_order", block_.blocked_order, levels_, "levels");
        if (block_.trials > pass_) report("trials", fmt::format("must be at most the number of conditions, {}", pass_));
    }

    void checkCatches() {
        const CatchPlan& plan = block_.catches;
        if (plan.trials == 0) return;
        const auto cells = cellsOf(block_, cellsOf(design_, 0, 0, "", 0));
        const auto parts = partedBy(design_, block_.blocked, cells.catches);
        if (cells.catches.empty() || parts.size() != levels_) {
            report("catch_trials", cells.catches.empty()
                                       ? "no level of a factor has catch = true"
                                       : "not every level of the blocked factor has catch conditions");
            return;
        }
        const std::size_t repeated = block_.order == Order::Shuffled ? static_cast<std::size_t>(block_.repetitions) : 1;
        const std::size_t ordinary = block_.trials > 0 ? block_.trials : pass_ * repeated;
        const std::size_t last = plan.to == 0 ? ordinary + plan.trials : std::min(plan.to, ordinary + plan.trials);
        const std::size_t room = last >= plan.from ? last - plan.from + 1 : 0;
        if (plan.trials > room)
            report("catch_trials", fmt::format("only {} of a pass may have one", counted(room, "position")));
    }

    void checkConstraints() {
        if (block_.constraints.empty()) return;
        if (block_.order != Order::Random && block_.order != Order::Shuffled)
            return report("constraints", "need order = \"random\" or \"shuffled\": other orders are fixed by balance");
        if (block_.trials > 0) return report("constraints", "cannot be combined with trials: which are left is random");
        const auto rules = rulesOf(design_, block_);
        const SessionKey anybody{};
        const auto items = itemsOf(poolsOf(design_, block_, anybody));
        const std::size_t before = problems_.size();
        for (std::size_t i = 0; i < rules.size(); ++i)
            if (auto reason = infeasible(items, rules[i])) report("constraints", std::move(*reason), i);
        if (problems_.size() > before) return;
        Random random(0);
        if (!constrainedOrder(items, rules, random)) report("constraints", "no order keeps to all of them together");
    }

    const Design& design_;
    const BlockPlan& block_;
    std::size_t number_;
    std::vector<Problem>& problems_;
    std::size_t pass_ = 0;    // conditions of a pass
    std::size_t levels_ = 1;  // of the blocked factor
};

}  // namespace

std::vector<Problem> problemsOf(const Design& design) {
    std::vector<Problem> problems;
    if (design.conditions.empty()) return problems;
    for (std::size_t b = 0; b < design.blocks.size(); ++b) BlockCheck(design, b, problems).check();
    if (problems.empty() && !design.blocks.empty() && sequencesOf(design) > kMaxSequences)
        problems.push_back({0, "order", 0,
                            fmt::format("all squares of the study together have {} rows; at most {}",
                                        sequencesOf(design), kMaxSequences)});
    return problems;
}

}  // namespace passung::design
