#pragma once

#include "tests/bench/contact_rows.h"

namespace passung::bench {

inline constexpr const char* kMillionGroup = "a million points";
inline constexpr const char* kOnePercent = "passung tick, 1 % in contact";

/// The tool with a shell of a million points in the bunny's field of 50 µm tolerance: one tick with 1 % of the points
/// inside, and whole queries at the pressed poses under node budgets, whose bounds must hold.
/// Errors: a part cannot be built.
Result<std::vector<Row>> millionRows(const ContactScene& scene, const Extent& extent);

}  // namespace passung::bench
