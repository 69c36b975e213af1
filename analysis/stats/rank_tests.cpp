#include "analysis/stats/rank_tests.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

namespace passung::stats {
namespace {

constexpr std::size_t kMostExact = 49;

struct Ranks {
    std::vector<double> of;  // each value, from 1; those of ties are their mean
    double ties = 0.0;       // sum of t³ - t over groups of t ties
};

Ranks ranksOf(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return values[i] < values[k]; });
    Ranks ranks{std::vector<double>(values.size()), 0.0};
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        const auto t = static_cast<double>(end - begin);
        for (std::size_t i = begin; i < end; ++i) ranks.of[order[i]] = static_cast<double>(begin) + 0.5 * (t + 1.0);
        ranks.ties += t * t * t - t;
    }
    return ranks;
}

/// Twice the smaller tail of a statistic whose whole values 0, 1 … have these frequencies.
double exactP(const std::vector<double>& frequencies, double statistic) {
    const auto at = static_cast<std::ptrdiff_t>(std::llround(statistic));
    const double all = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
    const double below = std::accumulate(frequencies.begin(), frequencies.begin() + at + 1, 0.0);
    const double above = std::accumulate(frequencies.begin() + at, frequencies.end(), 0.0);
    return std::min(1.0, 2.0 * std::min(below, above) / all);
}

/// By the normal distribution, half a step nearer to the mean.
double normalP(double statistic, double mean, double variance) {
    const double distance = std::max(0.0, std::abs(statistic - mean) - 0.5);
    return 2.0 * boost::math::cdf(boost::math::complement(boost::math::normal(), distance / std::sqrt(variance)));
}

/// How many sets of whole numbers from 1 to n have the sum 0, 1 …
std::vector<double> sumsOfSubsets(std::size_t n) {
    std::vector<double> sums(n * (n + 1) / 2 + 1, 0.0);
    sums[0] = 1.0;
    for (std::size_t k = 1; k <= n; ++k)
        for (std::size_t s = sums.size(); s-- > k;) sums[s] += sums[s - k];
    return sums;
}

/// How many orders of n and m things have 0, 1 … pairs with the first kind's behind.
std::vector<double> pairsBehind(std::size_t n, std::size_t m) {
    // Gaussian binomial coefficient: product of (1 - q^(m+i)) / (1 - q^i).
    std::vector<double> counts(n * m + 1, 0.0);
    counts[0] = 1.0;
    for (std::size_t i = 1; i <= n; ++i) {
        for (std::size_t s = counts.size(); s-- > m + i;) counts[s] -= counts[s - m - i];
        for (std::size_t s = i; s < counts.size(); ++s) counts[s] += counts[s - i];
    }
    return counts;
}

}  // namespace

TestResult wilcoxonSignedRank(std::span<const double> differences) {
    std::vector<double> sizes, signs;
    for (const double d : differences) {
        if (d == 0.0) continue;
        sizes.push_back(std::abs(d));
        signs.push_back(d);
    }
    if (sizes.empty()) return {};
    const Ranks ranks = ranksOf(sizes);
    TestResult test{0.0, 0.0};
    for (std::size_t i = 0; i < sizes.size(); ++i)
        if (signs[i] > 0.0) test.statistic += ranks.of[i];
    const auto n = static_cast<double>(sizes.size());
    const bool exact = ranks.ties == 0.0 && sizes.size() <= kMostExact && sizes.size() == differences.size();
    test.p = exact ? exactP(sumsOfSubsets(sizes.size()), test.statistic)
                   : normalP(test.statistic, n * (n + 1.0) / 4.0,
                             n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ranks.ties / 48.0);
    return test;
}

TestResult mannWhitney(std::span<const double> a, std::span<const double> b) {
    if (a.empty() || b.empty()) return {};
    std::vector<double> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const Ranks ranks = ranksOf(all);
    const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size()), sum = n + m;
    const double variance = n * m / 12.0 * (sum + 1.0 - ranks.ties / (sum * (sum - 1.0)));
    if (!(variance > 0.0)) return {};
    const auto of_a = ranks.of.begin() + static_cast<std::ptrdiff_t>(a.size());
    TestResult test{std::accumulate(ranks.of.begin(), of_a, 0.0) - 0.5 * n * (n + 1.0), 0.0};
    const bool exact = ranks.ties == 0.0 && std::max(a.size(), b.size()) <= kMostExact;
    test.p = exact ? exactP(pairsBehind(a.size(), b.size()), test.statistic)
                   : normalP(test.statistic, 0.5 * n * m, variance);
    return test;
}

TestResult friedman(const std::vector<std::vector<double>>& blocks) {
    if (blocks.size() < 2 || blocks.front().size() < 2) return {};
    const auto n = static_cast<double>(blocks.size()), k = static_cast<double>(blocks.front().size());
    std::vector<double> sums(blocks.front().size(), 0.0);
    double ties = 0.0;
    for (const std::vector<double>& block : blocks) {
        const Ranks ranks = ranksOf(block);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += ranks.of[i];
        ties += ranks.ties;
    }
    double squares = 0.0;
    for (const double sum : sums) squares += (sum - n * (k + 1.0) / 2.0) * (sum - n * (k + 1.0) / 2.0);
    const double scale = n * k * (k + 1.0) - ties / (k - 1.0);
    if (!(scale > 0.0)) return {};
    TestResult test{12.0 * squares / scale, 0.0};
    test.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(k - 1.0), test.statistic));
    return test;
}

}  // namespace passung::stats
