#include "study/questionnaire/cronbach_alpha.h"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace passung::questionnaire {
namespace {

constexpr double kRounding = 1e-12;  // relative, of sums over thousands of forms

/// Sum of squares about the mean: n - 1 cancels in the ratio.
double squares(const std::vector<double>& values) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum;
}

}  // namespace

std::optional<double> cronbachAlpha(const std::vector<std::vector<double>>& rows) {
    if (rows.size() < 2 || rows.front().size() < 2) return std::nullopt;
    const std::size_t items = rows.front().size();
    double of_items = 0.0;
    std::vector<double> sums(rows.size(), 0.0);
    for (std::size_t item = 0; item < items; ++item) {
        std::vector<double> column;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            column.push_back(rows[row][item]);
            sums[row] += rows[row][item];
        }
        of_items += squares(column);
    }
    const double of_sums = squares(sums);
    if (!(of_sums > kRounding * of_items)) return std::nullopt;  // sums that do not vary but for rounding
    if (std::abs(of_sums - of_items) <= kRounding * of_items) return 0.0;
    const auto k = static_cast<double>(items);
    return k / (k - 1.0) * (1.0 - of_items / of_sums);
}

}  // namespace passung::questionnaire
