#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/random.h"

namespace passung::design {

/// What an order must keep to.
enum class Rule {
    MaxRun,          // at most `count` trials of one class in a row
    MinDistance,     // of two trials of one class the later comes at least `count` trials after the earlier
    FirstNot,        // the first trial is not of `chosen`
    PositionWindow,  // trials of `chosen` stand at `from` … `to`, counted from 1
};

/// A rule over classes: levels of a factor, or the conditions themselves ("no_repeat" is MaxRun 1 over these).
struct Constraint {
    Rule rule = Rule::MaxRun;
    std::optional<std::size_t> factor = {};  // whose levels are the classes; none: every condition is one
    std::size_t count = 1;
    std::size_t chosen = 0;  // class
    std::size_t from = 1, to = 0;
};

/// A constraint with the class of every item. Items are what pools hold.
struct ItemRule {
    Constraint constraint;
    std::vector<std::size_t> class_of;
};

/// Items that may change places with one another; the order is pool after pool.
using Pools = std::vector<std::vector<std::size_t>>;

/// Why no order of the pools keeps to one rule, in words; nothing if one does or it is not known. MaxRun: the class
/// with most trials, m of N, needs m ≤ r (N - m + 1). MinDistance: q such classes need (m - 1) d + q ≤ N.
std::optional<std::string> infeasible(const Pools& pools, const ItemRule& rule);

/// True if the concatenated pools keep to all rules.
bool keepsTo(const Pools& pools, const std::vector<ItemRule>& rules);

struct ConstrainedOrder {
    Pools pools;
    int restarts = 0;    // shuffles thrown away
    bool exact = false;  // found by back-tracking
};

/// A random order that keeps to all rules. Shuffles every pool, then goes through the positions: an item that breaks a
/// rule changes places with a random later one of its pool that does not; where there is none it changes places with
/// any of its pool and the pass starts anew. After kMaxRepairs of these another shuffle, after kMaxRestarts of those
/// exact back-tracking for up to kMaxExact items. Nothing if there is no such order, or more than kMaxExact items, or
/// the search did not end within kMaxNodes.
std::optional<ConstrainedOrder> constrainedOrder(Pools pools, const std::vector<ItemRule>& rules, Random& random);

inline constexpr int kMaxRepairs = 1000;
inline constexpr int kMaxRestarts = 200;
inline constexpr std::size_t kMaxExact = 60;
inline constexpr long kMaxNodes = 1'000'000;

/// Share of `draws` plain shuffles that keep to all rules: the smaller, the better a participant can predict orders.
double acceptedShare(Pools pools, const std::vector<ItemRule>& rules, Random& random, int draws);

}  // namespace passung::design
