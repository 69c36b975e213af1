#pragma once

#include <optional>
#include <span>

#include "analysis/stats/probit_fit.h"

namespace passung::stats {

/// How well somebody tells two intervals apart, by impressions that err alike in both (Thurstone 1927, case V; Green
/// and Swets 1966, chapter 2). With x the difference of comparison and reference, on an axis on which the error is as
/// large everywhere, σ its standard deviation in one interval, λ the share of trials that are left to chance:
///   chance of naming the comparison = λ/2 + (1 - λ) Φ(x / (√2 σ))
/// One half at x = 0, whatever σ is; there is no bias towards an interval, because which one has the comparison is
/// drawn for every trial.
struct PairFit {
    double sigma = 0.0;                // most likely, > 0
    double sigma_low = 0.0;            // of the 95 % interval by likelihood ratio; 0: no lower bound
    std::optional<double> sigma_high;  // none: whoever guesses explains the answers, too
    double deviance = 0.0;             // of the counts

    /// Difference at which the comparison is named in 75 % of the trials without lapses: √2 σ Φ⁻¹(0.75).
    double jnd75() const;
};

/// `counts`: level: the difference x; positive: the comparison was named. `lapse`: λ, from 0 to below 1. Nothing where
/// no σ > 0 is the most likely one: no answers but at x = 0, or all of them right, or no better than guessing.
std::optional<PairFit> fitPairs(std::span<const LevelCount> counts, double lapse);

}  // namespace passung::stats
