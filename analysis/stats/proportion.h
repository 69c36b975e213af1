#pragma once

#include <cstddef>

#include "analysis/stats/interval.h"

namespace passung::stats {

/// Exact interval of a probability of which `successes` of `trials` were seen (Clopper and Pearson 1934): it holds the
/// truth with at least this confidence, whatever the truth is. @pre successes ≤ trials, trials > 0, 0 < confidence < 1
Interval clopperPearson(std::size_t successes, std::size_t trials, double confidence);

}  // namespace passung::stats
