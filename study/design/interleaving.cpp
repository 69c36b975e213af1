#include "study/design/interleaving.h"

#include <numeric>
#include <vector>

#include "core/base/assert.h"

namespace passung::design {

std::optional<std::size_t> drawTrack(std::span<const AdaptiveTrack> tracks, Random& random) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < tracks.size(); ++i)
        if (!tracks[i].finished()) open.push_back(i);
    if (open.empty()) return std::nullopt;
    return open[random.below(open.size())];
}

std::set<std::size_t> drawCatches(std::size_t trials, std::size_t catches, Random& random) {
    PASSUNG_ASSERT(catches <= trials);
    std::vector<std::size_t> numbers(trials);
    std::iota(numbers.begin(), numbers.end(), std::size_t{1});
    shuffle(numbers, random);
    return {numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(catches)};
}

}  // namespace passung::design
