#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/tick_record.h"
#include "study/measures/measures.h"

namespace passung::measures {

/// Every so many-th tick in contact is judged, and so many ticks of largest recorded depth and of largest force.
inline constexpr std::int64_t kJudgedEvery = 20;
inline constexpr std::size_t kJudgedLargest = 20;
/// An overlap of more than this [m] is one for exact_overlap_share: a thousandth of a hair, and ten times what rounded
/// poses and chords of round faces are off.
inline constexpr double kLeastOverlap = 2e-6;
/// What a search that ended as it should leaves open between depth and bound [m], and a little more.
inline constexpr double kOverlapLeftOpen = 3e-6;
inline constexpr double kOverlapShareLeftOpen = 0.05;  // of the depth, besides

/// Which trial ticks are judged by exact geometry after the trial, in the order of ticks; their depths are still 0.
/// `records`: the first hand's; `hands`: of a scene with several, those of each, the first included: then a tick is in
/// contact if any hand is, and its depth and force are the largest of any.
std::vector<TickOverlap> ticksToJudge(std::span<const TickRecord> records, const TrialContext& context,
                                      std::span<const std::span<const TickRecord>> hands = {});

}  // namespace passung::measures
