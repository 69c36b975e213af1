#include "tests/hard/known_misses.h"

#include <array>

namespace passung::hard {

std::span<const KnownMiss> knownMisses() {
    static constexpr std::array kMisses{
        // The heuristic keeps a hundredth of a cell of overlap, k = 2.5 um, at both contacts: it leans as in a bore
        // that is wider by 2 k, farther by 2 k/(D - d) = 2.5 % of the clearance's 0.2 mm. (The god object keeps a
        // fifth of that.)
        KnownMiss{"a6_peg_tilt", "god_object_heuristic"},
    };
    return kMisses;
}

}  // namespace passung::hard
