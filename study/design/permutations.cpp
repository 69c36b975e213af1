#include "study/design/permutations.h"

#include <numeric>

#include "core/base/assert.h"

namespace passung::design {

std::size_t permutationCount(std::size_t n) {
    std::size_t count = 1;
    for (std::size_t i = 2; i <= n; ++i) count *= i;
    return count;
}

std::vector<std::size_t> permutation(std::size_t n, std::size_t row) {
    PASSUNG_ASSERT(row < permutationCount(n));
    std::vector<std::size_t> left(n), order;
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (std::size_t rest = n; rest-- > 0;) {
        const std::size_t orders = permutationCount(rest);  // of what follows this entry
        const auto next = left.begin() + static_cast<std::ptrdiff_t>(row / orders);
        row %= orders;
        order.push_back(*next);
        left.erase(next);
    }
    return order;
}

}  // namespace passung::design
