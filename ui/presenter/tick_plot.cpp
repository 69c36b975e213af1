#include "ui/presenter/tick_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::presenter {

namespace {

constexpr double kLeastShare = 1e-4;  // an error of nothing at all is drawn at this share of the largest one
constexpr double kMargin = 1.25;      // of an axis beyond its values, as a factor
constexpr double kNarrow = 2.0;       // decades: below, 2 and 5 are written too

/// Around values that are above 0.
LogAxis axisAround(double low, double high) {
    LogAxis axis{low / kMargin, high * kMargin, {}};
    const bool narrow = std::log10(axis.high / axis.low) < kNarrow;
    const int last = static_cast<int>(std::ceil(std::log10(axis.high)));
    for (int decade = static_cast<int>(std::floor(std::log10(axis.low))); decade <= last; ++decade)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double tick = digit * std::pow(10.0, decade);
            if ((digit == 1.0 || narrow) && tick >= axis.low && tick <= axis.high) axis.ticks.push_back(tick);
        }
    return axis;
}

PlotPoint pointOf(const truth::PathCost& row, TickError error) {
    const bool overlap = error == TickError::Overlap;
    PlotPoint point;
    point.time_low = 1e6 * row.time.median;
    point.time = 1e6 * row.time.p999;
    point.error_low = overlap ? 1e6 * row.overlap : 100.0 * row.force.median;
    point.error = overlap ? 1e6 * row.overlap_bound : 100.0 * row.force.p99;
    point.front = overlap ? row.on_overlap_front : row.on_force_front;
    return point;
}

}  // namespace

double LogAxis::shareOf(double value) const { return std::log(std::max(value, low) / low) / std::log(high / low); }

TickPlot tickPlot(const run::TickFront& front, TickError error, const scene::SceneSpec& study) {
    TickPlot plot;
    const auto& rows = front.measured.rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        PlotPoint point = pointOf(rows[i], error);
        if (!std::isfinite(point.error) || !(point.time_low > 0.0)) continue;
        point.row = i;
        point.in_study = run::isRenderedBy(study, front, rows[i].setting);
        plot.points.push_back(point);
    }
    std::stable_sort(plot.points.begin(), plot.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.time < b.time; });
    double fast = std::numeric_limits<double>::infinity(), slow = 0.0, low = fast, high = 0.0;
    for (const PlotPoint& point : plot.points) {
        fast = std::min(fast, point.time_low);
        slow = std::max(slow, point.time);
        high = std::max(high, point.error);
        for (const double value : {point.error_low, point.error})
            if (value > 0.0) low = std::min(low, value);
    }
    if (plot.points.empty()) return plot;
    plot.time = axisAround(fast, slow);
    plot.error = high > 0.0 ? axisAround(std::max(low, kLeastShare * high), high) : LogAxis{0.1, 1.0, {0.1, 1.0}};
    return plot;
}

std::optional<std::size_t> nextOnFront(const TickPlot& plot, std::optional<std::size_t> from, int step) {
    const auto count = static_cast<std::ptrdiff_t>(plot.points.size());
    std::ptrdiff_t at = from ? static_cast<std::ptrdiff_t>(*from) : step > 0 ? -1 : count;
    for (at += step; at >= 0 && at < count; at += step)
        if (plot.points[static_cast<std::size_t>(at)].front) return static_cast<std::size_t>(at);
    return std::nullopt;
}

}  // namespace passung::presenter
