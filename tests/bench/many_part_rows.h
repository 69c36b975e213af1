#pragma once

#include <string>

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kPartsGroup = "parts out of reach, peg in hole";

/// What still parts that nothing touches cost: a simulated trial of the study `protocol`, a peg_in_hole, replayed among
/// none, 200 and 10 000 equal boxes of 20 mm, none nearer than 0.12 m to the plate's middle, on closed forms, surfaces
/// and fields. Times are of the thread, of each tick the fastest of the repetitions; `figure`: by how much the median
/// or the 99.9th percentile is more than without boxes, whichever is more.
///   Memory: the resident set of a process that holds the scene and its state and has done 2 000 ticks, with 200 boxes
/// more than without.
/// Errors: the study cannot be read, a scene cannot be built.
Result<std::vector<Row>> manyPartRows(const std::string& protocol, const Extent& extent);

}  // namespace passung::bench
