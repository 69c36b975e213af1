#include "analysis/stats/pair_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::stats {
namespace {

constexpr double kChiSquare95 = 3.841458820694124;  // one degree of freedom
constexpr double kWidest = 1e3;                     // σ is looked for in the differences over and times this
constexpr double kQuarter = 0.6744897501960817;     // Φ⁻¹(0.75)
constexpr int kGrid = 600;
constexpr int kHalvings = 80;

/// Deviance as a function of log σ, up to what does not depend on it.
class Likelihood {
public:
    Likelihood(std::span<const LevelCount> counts, double lapse) : counts_(counts), lapse_(lapse) {}

    double chance(double x, double log_sigma) const {
        const double z = x / (std::numbers::sqrt2 * std::exp(log_sigma));
        return 0.5 * lapse_ + (1.0 - lapse_) * 0.5 * std::erfc(-z / std::numbers::sqrt2);
    }
    /// 2 sum of k ln(k / (n p)) + (n - k) ln((n - k) / (n (1 - p)))
    double deviance(double log_sigma) const {
        const auto part = [](double seen, double expected) {
            return seen > 0.0 ? seen * std::log(seen / std::max(expected, 1e-300)) : 0.0;
        };
        double sum = 0.0;
        for (const LevelCount& count : counts_) {
            const double p = chance(count.level, log_sigma);
            sum += part(count.positive, count.trials * p);
            sum += part(count.trials - count.positive, count.trials * (1.0 - p));
        }
        return 2.0 * sum;
    }

private:
    std::span<const LevelCount> counts_;
    double lapse_;
};

/// Where the deviance is least between two places about the least of a grid: golden section.
double leastBetween(const Likelihood& likelihood, double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < kHalvings; ++i) {
        const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
        if (likelihood.deviance(a) <= likelihood.deviance(b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

/// Where the deviance passes `limit` on the way from inside to `outside`; nothing if it does not.
std::optional<double> crossing(const Likelihood& likelihood, double inside, double outside, double limit) {
    if (!(likelihood.deviance(outside) > limit)) return std::nullopt;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (inside + outside);
        (likelihood.deviance(middle) > limit ? outside : inside) = middle;
    }
    return 0.5 * (inside + outside);
}

}  // namespace

double PairFit::jnd75() const { return std::numbers::sqrt2 * sigma * kQuarter; }

std::optional<PairFit> fitPairs(std::span<const LevelCount> counts, double lapse) {
    double nearest = 0.0, farthest = 0.0;
    for (const LevelCount& count : counts) {
        const double x = std::abs(count.level);
        if (!(x > 0.0) || !(count.trials > 0.0)) continue;
        nearest = nearest > 0.0 ? std::min(nearest, x) : x;
        farthest = std::max(farthest, x);
    }
    if (!(farthest > 0.0)) return std::nullopt;
    const Likelihood likelihood(counts, lapse);
    const double low = std::log(nearest / kWidest), high = std::log(farthest * kWidest);
    const double step = (high - low) / kGrid;
    int best = 0;
    for (int i = 1; i <= kGrid; ++i)
        if (likelihood.deviance(low + i * step) < likelihood.deviance(low + best * step)) best = i;
    if (best == 0 || best == kGrid) return std::nullopt;
    const double most = leastBetween(likelihood, low + (best - 1) * step, low + (best + 1) * step);
    // As good as where all is clear, or all is chance: no σ is the most likely one.
    const double least = likelihood.deviance(most);
    if (!(likelihood.deviance(low) > least + 1e-9 && likelihood.deviance(high) > least + 1e-9)) return std::nullopt;
    PairFit fit{.sigma = std::exp(most), .sigma_low = 0.0, .sigma_high = std::nullopt, .deviance = least};
    if (const auto bound = crossing(likelihood, most, low, least + kChiSquare95)) fit.sigma_low = std::exp(*bound);
    if (const auto bound = crossing(likelihood, most, high, least + kChiSquare95)) fit.sigma_high = std::exp(*bound);
    return fit;
}

}  // namespace passung::stats
