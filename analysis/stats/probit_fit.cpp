#include "analysis/stats/probit_fit.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace passung::stats {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kSmallestChance = 1e-12;

const boost::math::normal kNormal;

double chanceAt(const ProbitFit& fit, double level) {
    return std::clamp(cdf(kNormal, fit.intercept + fit.slope * level), kSmallestChance, 1.0 - kSmallestChance);
}

/// 2 sum of k ln(k / (n p)) + (n - k) ln((n - k) / (n (1 - p)))
double devianceOf(const ProbitFit& fit, std::span<const LevelCount> counts) {
    const auto part = [](double seen, double expected) { return seen > 0.0 ? seen * std::log(seen / expected) : 0.0; };
    double sum = 0.0;
    for (const LevelCount& count : counts) {
        const double p = chanceAt(fit, count.level);
        sum += part(count.positive, count.trials * p) + part(count.trials - count.positive, count.trials * (1.0 - p));
    }
    return 2.0 * sum;
}

/// One step: the weighted line through the working responses; false if the levels leave it open.
bool improve(ProbitFit& fit, std::span<const LevelCount> counts) {
    double w = 0.0, wx = 0.0, wxx = 0.0, wz = 0.0, wxz = 0.0;
    for (const LevelCount& count : counts) {
        const double eta = fit.intercept + fit.slope * count.level;
        const double p = chanceAt(fit, count.level), density = pdf(kNormal, eta);
        if (!(density > 0.0)) continue;
        const double weight = count.trials * density * density / (p * (1.0 - p));
        const double response = eta + (count.positive / count.trials - p) / density;
        w += weight;
        wx += weight * count.level;
        wxx += weight * count.level * count.level;
        wz += weight * response;
        wxz += weight * count.level * response;
    }
    const double determinant = w * wxx - wx * wx;
    if (!(determinant > 1e-12 * w * wxx)) return false;
    fit.slope = (w * wxz - wx * wz) / determinant;
    fit.intercept = (wxx * wz - wx * wxz) / determinant;
    return std::isfinite(fit.slope) && std::isfinite(fit.intercept);
}

}  // namespace

double ProbitFit::jnd75() const { return sigma() * quantile(kNormal, 0.75); }

std::optional<ProbitFit> fitProbit(std::span<const LevelCount> counts) {
    ProbitFit fit;
    for (int step = 0; step < kMaxSteps; ++step) {
        const ProbitFit before = fit;
        if (!improve(fit, counts)) return std::nullopt;
        const double moved = std::abs(fit.slope - before.slope) + std::abs(fit.intercept - before.intercept);
        if (moved > 1e-12 * (std::abs(fit.slope) + std::abs(fit.intercept))) continue;
        fit.deviance = devianceOf(fit, counts);
        return fit;
    }
    return std::nullopt;
}

}  // namespace passung::stats
