#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/run/machine/tick_front.h"

namespace passung::presenter {

/// What is drawn over the time of a tick.
enum class TickError { Overlap, Force };

/// A measured setting as it is drawn: its mark is at the larger end of both bars. Times in µs; errors in µm, or in
/// percent of the force.
struct PlotPoint {
    std::size_t row = 0;                  // of the measured ones
    double time_low = 0.0, time = 0.0;    // median, 99.9th percentile
    double error_low = 0.0, error = 0.0;  // found and proven; median and 99th percentile
    bool front = false;                   // none is both faster and nearer the truth
    bool in_study = false;                // the study's own setting
};

/// A logarithmic axis with what is written beside it, within.
struct LogAxis {
    double low = 0.1, high = 1.0;
    std::vector<double> ticks;
    /// From 0 at `low` to 1 at `high`; what is less than low is drawn there.
    double shareOf(double value) const;
};

/// The settings that have this error, from fast to slow. Axes of a plot without points mean nothing.
struct TickPlot {
    std::vector<PlotPoint> points;
    LogAxis time, error;
};
TickPlot tickPlot(const run::TickFront& front, TickError error, const scene::SceneSpec& study);

/// The place among `points` of the next one of the front towards slow (+1) or fast (-1) from the point `from`; of none:
/// the first or last. Nothing where there is no further one.
std::optional<std::size_t> nextOnFront(const TickPlot& plot, std::optional<std::size_t> from, int step);

}  // namespace passung::presenter
