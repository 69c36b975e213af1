#pragma once

#include <optional>
#include <span>

namespace passung::stats {

/// So many of `trials` at one level were positive.
struct LevelCount {
    double level = 0.0;
    double positive = 0.0;
    double trials = 0.0;
};

/// A psychometric function fitted to them: chance of a positive answer Phi(intercept + slope · level).
struct ProbitFit {
    double intercept = 0.0, slope = 0.0;
    double deviance = 0.0;

    double middle() const { return -intercept / slope; }  // level of 50 % (the point of subjective equality)
    double sigma() const { return 1.0 / slope; }
    double jnd75() const;  // from there to 75 %
};

/// The most likely one: a generalised linear model with probit link, by iteratively re-weighted least squares
/// (McCullagh and Nelder 1989, section 2.5). Nothing where there is none: fewer than two levels, or answers that no
/// finite slope explains best.
std::optional<ProbitFit> fitProbit(std::span<const LevelCount> counts);

}  // namespace passung::stats
