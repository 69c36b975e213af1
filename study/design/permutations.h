#pragma once

#include <cstddef>
#include <vector>

namespace passung::design {

inline constexpr std::size_t kMaxPermuted = 5;  // more have too many orders for any study

/// n! @pre n ≤ 20
std::size_t permutationCount(std::size_t n);

/// Order number `row` of all orders of 0 … n-1, in lexicographic order. @pre row < permutationCount(n)
std::vector<std::size_t> permutation(std::size_t n, std::size_t row);

}  // namespace passung::design
