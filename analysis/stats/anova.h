#pragma once

#include <span>
#include <vector>

#include "analysis/stats/test_result.h"

namespace passung::stats {

/// Welch's t test of two independent samples with variances of their own (Satterthwaite's degrees of freedom). Not
/// defined for fewer than two values in a sample, or without any variance.
TestResult welchT(std::span<const double> a, std::span<const double> b);

/// Analysis of variance of independent groups (F). Not defined for fewer than two groups with values, or without any
/// variance in them.
TestResult oneWayAnova(const std::vector<std::vector<double>>& groups);

/// The main effect of a factor that varies within persons, in groups that a between factor makes (one group: repeated
/// measures). `groups[g][i]` are one person's values, one for each level. F by sums of squares of type III, its degrees
/// of freedom corrected by Greenhouse and Geisser's epsilon of the covariance pooled over the groups. Not defined for
/// fewer than two levels, an empty group, no more persons than groups, or without variance of the differences.
TestResult withinAnova(const std::vector<std::vector<std::vector<double>>>& groups);

}  // namespace passung::stats
