#pragma once

#include <cstddef>
#include <span>

#include "analysis/stats/interval.h"

namespace passung::stats {

/// Student's t test of paired differences against 0, two-sided. NaN where it is not defined: everything of no pair, all
/// but the mean of one; t and p if all differences are 0. Equal differences other than 0 have an infinite t and p = 0.
struct PairedT {
    std::size_t n = 0;
    double mean = 0.0;
    double sd = 0.0;  // of the differences, n - 1 degrees of freedom
    double t = 0.0;
    double p = 0.0;
};
PairedT pairedT(std::span<const double> differences);

/// Of the mean difference, from Student's t. @pre n ≥ 2, 0 < confidence < 1
Interval meanInterval(std::size_t n, double mean, double sd, double confidence);

/// Probability that the test is significant at `alpha` if the differences are normal with mean / sd = `d`: both tails
/// of the non-central t with n - 1 degrees of freedom and non-centrality d √n. @pre n > 1, 0 < alpha < 1
double pairedPower(double d, double n, double alpha);

/// The n, a real number ≥ 2, at which that probability is `power`; infinite above a million.
/// @pre alpha < power < 1
double pairedSize(double d, double power, double alpha);

}  // namespace passung::stats
