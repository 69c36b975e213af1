#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/design/design.h"

namespace passung::design {

/// How even the orders of the participants with these slots are: a line for everything that takes turns, with smallest
/// and largest counts of positions and direct neighbours (of an assignment: of its pairs).
std::vector<std::string> balanceLines(const Design& design, std::span<const std::size_t> slots);

}  // namespace passung::design
