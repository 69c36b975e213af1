#pragma once

#include <string>
#include <vector>

#include "analysis/truth/accuracy_ticks.h"

namespace passung::truth {

/// What tickCsv() wrote, with the digits that stand there. Errors, with their lines: no header, a column that is
/// missing, a cell that is none of its column. `first_line`: of the header in `file`.
Result<std::vector<PathCost>> readTickCsv(const std::string& text, const std::string& file, int first_line);

}  // namespace passung::truth
