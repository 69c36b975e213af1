#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "study/measures/measures.h"
#include "study/measures/smooth_motion.h"
#include "study/measures/tick_of_hands.h"

namespace passung::measures {

using Optional = std::optional<double>;

inline constexpr double kPeriodsPerSecond =
    1000.0;  // exact, unlike a period's length: 4028 of them are 4.028 s to the last digit

/// Records of one hand in a trial.
struct HandTicks {
    std::span<const TickRecord> ticks;   // start_tick ≤ tick < end_tick: the formulas' "trial ticks"
    std::span<const TickRecord> points;  // the same and the record at end_tick

    /// Periods that tick `i` stands for; 1 where the next tick was not recorded.
    double lengthOf(std::size_t i) const {
        const bool followed = i + 1 < points.size() && points[i + 1].tick == points[i].tick + 1;
        return followed ? points[i + 1].periods : 1.0;
    }
};

/// A trial cut to its ticks. Each tick stands for the time that begins with it and ends with the next one, so the
/// record at end_tick only closes the last step. Times are haptic periods after the start tick.
struct Trial {
    const TrialContext& context;
    std::span<const TickRecord> ticks;       // HandTicks::ticks of the first hand, as the trial is judged
    std::span<const TickRecord> points;      // HandTicks::points
    std::vector<HandTicks> hands;            // all of them, in the world; of one hand the two above
    std::vector<SmoothMotion> motions;       // of each of `hands`, of its points
    std::vector<TickOfHands> together;       // of each of `ticks`
    std::int64_t end = 0;                    // time of the end tick
    std::optional<std::int64_t> leave;       // of any hand
    std::optional<std::int64_t> touch;       // first contact tick of any hand
    std::optional<std::int64_t> engagement;  // first tick with the tip deep enough in the bore

    bool succeeded() const { return context.outcome == Outcome::Success; }
    double lengthOf(std::size_t i) const { return HandTicks{ticks, points}.lengthOf(i); }
};

inline double seconds(std::int64_t from, std::int64_t to) { return static_cast<double>(to - from) / kPeriodsPerSecond; }

struct Measure {
    MeasureDefinition definition;
    Optional (*compute)(const Trial&);
};

}  // namespace passung::measures
