#pragma once

#include <string>
#include <vector>

#include "tests/bench/row.h"

namespace passung::bench {

/// A figure that the program has to reach.
struct Mark {
    std::string name;
    double value = kNotGiven;  // NaN: nothing measured, or no setting is accurate enough
    double limit = 0.0;
    std::string unit = {};
    std::string note = {};  // which setting, and what stands against it
    bool at_least = false;  // met if value ≥ limit, else if value ≤ limit
    bool met() const { return at_least ? value >= limit : value <= limit; }
};

/// A speed counts only at a setting whose worst errors are ≤ 20 µm and ≤ 1 % / 0.5° (force), ≤ 1 % (torque).
bool isAccurate(const Row& row);

/// Every mark there is. What the rows do not hold is a mark without a value, which is not met.
std::vector<Mark> judge(const std::vector<Row>& rows);
/// One line each: met or missed, value, limit, the setting and its errors.
std::string describe(const std::vector<Mark>& marks);
bool allMet(const std::vector<Mark>& marks);

}  // namespace passung::bench
