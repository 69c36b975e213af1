#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/path/free_room.h"

namespace passung::path {

struct SearchLimits {
    double seconds = 30.0;  // of the wall clock, > 0: a search that ends before is the same for the same seed
};

/// The seed of all searches of the program that come after, > 0. To be called before the first of them.
void seedSearches(std::uint32_t seed);

/// A path from `X_start` to `X_goal` on which no triangles meet, searched as a disassembly; nothing if none was found
/// within the limits, which proves nothing. @pre neither end overlaps.
///
/// In a bore whose play is a thousandth of its depth no random pose is free, and no random straight way leads out. So
/// both ends are left by what slides along contacts: straight pulls along the axes of the part's frame first, then a
/// tree of pulls (OMPL's control::RRT; LaValle 1998), whose steps are those of a god object (FreeRoom::slide). An end
/// is left where nothing is within kOut of the part's reach. From there on RRTConnect (Kuffner and LaValle 2000) joins
/// them by straight ways that are proven to be free; where it does not, a tree of pulls from the start's side goes on
/// until a straight way leads to the other. The path is made shorter in the end.
std::optional<std::vector<Pose>> findPath(const FreeRoom& room, const Pose& X_start, const Pose& X_goal,
                                          const SearchLimits& limits);

}  // namespace passung::path
