#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace passung::design {

/// One order a row, each a permutation of 0 … n-1.
using Square = std::vector<std::vector<std::size_t>>;

/// How many rows the square of `n` conditions has: n if n is even, else 2n.
std::size_t williamsRows(std::size_t n);

/// Orders that balance position and first-order carry-over (Williams 1949). @pre n ≥ 2.
///
/// First row: 0, 1, n-1, 2, n-2, 3 …: after 0 alternately the lowest and the highest that is left. Row r adds r to
/// each entry, modulo n. For odd n the same rows follow once more, each reversed.
///
/// Invariants: every condition stands in every position equally often (once; odd n: twice); every ordered pair of
/// different conditions follows one another directly equally often (once; odd n: twice). Both hold only over all
/// rows: with odd n, the first n rows alone balance position but not carry-over.
Square williamsSquare(std::size_t n);

/// Smallest and largest count of something that ought to be equal everywhere.
struct CountRange {
    int low = 0;
    int high = 0;
    bool even() const { return low == high; }
};

/// "2" or "1-2".
std::string rangeText(const CountRange& range);

/// How even a set of orders is.
struct Balance {
    CountRange positions;   // how often a condition stands in a position, over all conditions and positions
    CountRange neighbours;  // how often one condition directly follows another, over all ordered pairs
};

/// @pre every row is a permutation of 0 … n-1 with the same n ≥ 1.
Balance balanceOf(const Square& orders);

/// The orders that `participants` people get when the one in slot s takes row s mod rows. @pre conditions ≥ 2.
Square assignedRows(std::size_t participants, std::size_t conditions);

/// What an experimenter should know about `participants` people with `conditions` conditions, as one sentence.
/// @pre conditions ≥ 2, participants ≥ 1.
std::string balanceSentence(std::size_t participants, std::size_t conditions);

}  // namespace passung::design
