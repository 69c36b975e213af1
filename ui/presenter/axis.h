#pragma once

#include <vector>

namespace passung::presenter {

/// The smallest of 1, 2, 5 × 10^n that is at least `value`. @pre value > 0
double roundScale(double value);

/// Where an axis from `low` to `high` has its marks: multiples of a round step, about `about` of them, the outermost at
/// or beyond both ends. @pre finite, about ≥ 1
std::vector<double> axisMarks(double low, double high, int about);

}  // namespace passung::presenter
