#pragma once

#include <optional>
#include <vector>

namespace passung::questionnaire {

/// Internal consistency of k items (Cronbach 1951): k/(k-1) · (1 - sum of the items' variances / variance of the sums),
/// variances with n - 1. `rows`: one per person, all items answered and aligned. Nothing for less than two rows or
/// items, and where the sums do not vary.
/// @pre rows of equal length
std::optional<double> cronbachAlpha(const std::vector<std::vector<double>>& rows);

}  // namespace passung::questionnaire
