#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/design/design.h"
#include "study/design/williams.h"

namespace passung::design {

/// How even the orders of some slots are in one thing that takes turns.
struct FactorBalance {
    CounterbalancingFactor balancing;
    std::size_t rows = 0;  // of the counterbalancing factor's list of orders
    Balance counts;        // of an assignment `positions` alone, which are its pairs
    bool even = false;
};

/// Balance of everything that takes turns, for participants with these slots; none without slots.
std::vector<FactorBalance> balancesOf(const Design& design, std::span<const std::size_t> slots);

/// How many participants show all rows in all groups equally often.
std::size_t evenNumber(const Design& design);

/// How even the orders of the participants with these slots are: a line for everything that takes turns, with smallest
/// and largest counts of positions and direct neighbours (of an assignment: of its pairs).
std::vector<std::string> balanceLines(const Design& design, std::span<const std::size_t> slots);

}  // namespace passung::design
