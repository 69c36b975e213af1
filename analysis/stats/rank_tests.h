#pragma once

#include <span>
#include <vector>

#include "analysis/stats/test_result.h"

namespace passung::stats {

/// Wilcoxon's signed-rank test of paired differences against 0; the statistic is the sum of the ranks of positive ones.
/// Zeros are left out. Exact for at most 49 differences without ties, else by the normal distribution with corrections
/// for ties and continuity. Not defined without a difference other than 0.
TestResult wilcoxonSignedRank(std::span<const double> differences);

/// The test of Wilcoxon, Mann and Whitney that neither of two independent samples tends to larger values; the statistic
/// is how many pairs of `a` and `b` have the larger value in `a`, ties by half. Exact for at most 49 values each
/// without ties, else by the normal distribution with corrections for ties and continuity. Not defined for an empty
/// sample or equal values only.
TestResult mannWhitney(std::span<const double> a, std::span<const double> b);

/// Friedman's test that the treatments of a block design differ in no rank: `blocks` hold one value for each treatment.
/// The statistic, corrected for ties, is referred to chi-square. Not defined for fewer than two blocks or treatments,
/// or if every block's values are equal.
TestResult friedman(const std::vector<std::vector<double>>& blocks);

}  // namespace passung::stats
