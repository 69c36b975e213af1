#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>

#include "core/base/random.h"
#include "study/design/adaptive.h"

namespace passung::design {

/// One of the tracks that are not finished, each as likely; nothing if all are. Draw from a stream of each trial's own:
/// then who comes next depends on nothing but the trial and what is finished, however often a trial was repeated.
std::optional<std::size_t> drawTrack(std::span<const AdaptiveTrack> tracks, Random& random);

/// Which of `trials` trials, from 1, are the catch trials: so many, every choice as likely. @pre catches ≤ trials
std::set<std::size_t> drawCatches(std::size_t trials, std::size_t catches, Random& random);

}  // namespace passung::design
