#pragma once

#include <limits>

#include "study/protocol/key_table.h"

/// Ranges as rows of the key table write them.
namespace passung::protocol::ranges {

inline constexpr Range kAny{};

constexpr Range above(double low) {
    return {.low = low, .high = std::numeric_limits<double>::infinity(), .low_excluded = true};
}

constexpr Range atLeast(double low) {
    return {.low = low, .high = std::numeric_limits<double>::infinity(), .low_excluded = false};
}

constexpr Range from(double low, double high) { return {.low = low, .high = high, .low_excluded = false}; }

constexpr Range aboveUpTo(double low, double high) { return {.low = low, .high = high, .low_excluded = true}; }

}  // namespace passung::protocol::ranges
