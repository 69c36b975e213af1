#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/truth/accuracy_tick_tables.h"
#include "analysis/truth/svg.h"
#include "core/scene/contact_geometry.h"

namespace passung::truth {

namespace {

constexpr double kWidth = 1560, kHeight = 730;
constexpr double kTop = 132, kPlotHeight = 450, kPlotWidth = 360, kLeft = 78, kPitch = 770;
constexpr double kLeastShare = 1e-4;  // an error of nothing at all is drawn at this share of the largest one

/// A value with its bar, from `low` to `high`; the value is `high`.
struct PlotBar {
    double low, high;
};

struct Panel {
    const char* title;
    const char* axis;
    const char* empty;
    PlotBar (*error)(const PathCost&);
    bool PathCost::*front;
};

std::string titleOf(const TickPictureText& text) {
    return "What accuracy costs a tick: " + text.scene + " along " + text.path;
}

PlotBar timeOf(const PathCost& row) { return {1e6 * row.time.median, 1e6 * row.time.p999}; }
PlotBar overlapOf(const PathCost& row) { return {1e6 * row.overlap, 1e6 * row.overlap_bound}; }
PlotBar forceOf(const PathCost& row) { return {100.0 * row.force.median, 100.0 * row.force.p99}; }

constexpr scene::ContactMethod kMethods[] = {scene::ContactMethod::Penalty, scene::ContactMethod::GodObjectHeuristic,
                                             scene::ContactMethod::GodObject};
constexpr scene::Geometry kGeometries[] = {scene::Geometry::Field, scene::Geometry::ClosedForm,
                                           scene::Geometry::Surface};

const char* colourOf(scene::ContactMethod method) {
    return kColours[std::find(std::begin(kMethods), std::end(kMethods), method) - std::begin(kMethods)];
}

PlotMark markOf(scene::Geometry geometry) {
    return geometry == scene::Geometry::Field        ? PlotMark::Disc
           : geometry == scene::Geometry::ClosedForm ? PlotMark::Diamond
                                                     : PlotMark::Up;
}

void drawRow(Svg& svg, const PathCost& row, const PlotAxis& x, const PlotAxis& y, const PlotBar& error, bool front) {
    const PlotBar time = timeOf(row);
    const char* colour = colourOf(row.setting.method);
    const auto height = [&](double value) { return y.at(std::max(y.low, value)); };
    svg.line(x.at(std::max(x.low, time.low)), height(error.high), x.at(time.high), height(error.high), colour, 1);
    svg.line(x.at(time.high), height(error.low), x.at(time.high), height(error.high), colour, 1);
    svg.mark(x.at(time.high), height(error.high), front ? 6 : 4, markOf(row.setting.geometry), colour,
             front ? 1.0 : 0.5, front ? kInk : colour);
}

void drawPanel(Svg& svg, const Panel& panel, const std::vector<PathCost>& rows, double left) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0, fast = low, slow = 0.0;
    std::vector<const PathCost*> shown;
    for (const PathCost& row : rows) {
        const PlotBar error = panel.error(row), time = timeOf(row);
        if (!std::isfinite(error.high)) continue;
        shown.push_back(&row);
        fast = std::min(fast, time.low);
        slow = std::max(slow, time.high);
        high = std::max(high, error.high);
        for (const double value : {error.low, error.high})
            if (value > 0.0) low = std::min(low, value);
    }
    svg.text(left, kTop - 16, panel.title, kHeading);
    if (!(high > 0.0)) return svg.text(left, kTop + 30, shown.empty() ? panel.empty : "No error at all.", kPlain);
    const PlotAxis x = axisAround(fast, slow, left, left + kPlotWidth);
    const PlotAxis y = axisAround(std::max(low, kLeastShare * high), high, kTop + kPlotHeight, kTop);
    drawAxes(svg, x, y, "processor time of a tick, from median to 99.9th percentile [µs]", panel.axis);
    std::stable_sort(shown.begin(), shown.end(),
                     [](const PathCost* a, const PathCost* b) { return a->time.p999 < b->time.p999; });
    std::string path;
    std::vector<PlotLabel> labels;
    for (const PathCost* row : shown) {
        if (!(row->*panel.front)) {
            drawRow(svg, *row, x, y, panel.error(*row), false);
            continue;
        }
        labels.push_back(
            {x.at(timeOf(*row).high), y.at(std::max(y.low, panel.error(*row).high)), settingText(row->setting)});
        path += fmt::format("{:.1f},{:.1f} ", labels.back().x, labels.back().y);
    }
    drawLabels(svg, labels, x, y);
    svg.add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.8"/>)", path, kInk);
    for (const PathCost* row : shown)
        if (row->*panel.front) drawRow(svg, *row, x, y, panel.error(*row), true);
}

void drawLegend(Svg& svg) {
    double x = kLeft, y = kHeight - 66;
    const auto entry = [&](PlotMark mark, const char* colour, const std::string& word) {
        svg.mark(x, y, 6, mark, colour, 1.0, kInk);
        svg.text(x + 13, y + 4.5, word, kPlain);
        x += 40 + 7.5 * static_cast<double>(word.size());
    };
    for (const auto method : kMethods) entry(PlotMark::Disc, colourOf(method), scene::methodName(method));
    x += 22;
    for (const auto geometry : kGeometries) entry(markOf(geometry), "#FFFFFF", scene::geometryName(geometry));
    x = kLeft;
    y += 30;
    svg.line(x, y, x + 30, y, kInk, 1.8);
    svg.text(x + 42, y + 4.5,
             "Pareto front: no other setting is both faster and nearer the truth. Bars: from median to mark; of the "
             "overlap from what was found to what is proven.",
             kPlain);
}

}  // namespace

bool isTickPictureOf(const std::string& picture, const TickPictureText& text) {
    return picture.find(">" + escaped(titleOf(text)) + "</text>") != std::string::npos;
}

std::string tickPicture(const TickAccuracy& result, const TickPictureText& text) {
    Svg svg(kWidth, kHeight);
    svg.text(kLeft - 56, 38, titleOf(text), kTitle);
    svg.text(kLeft - 56, 64,
             fmt::format("{} settings along the same {} ticks. Lower is nearer the truth, further left is faster.",
                         result.rows.size(), result.rows.empty() ? 0 : result.rows.front().ticks),
             kPlain);
    const Panel panels[] = {
        {"True overlap of what is shown", "largest overlap, from found to proven [µm]", "No obstacle.", overlapOf,
         &PathCost::on_overlap_front},
        {"Force", "error of the force's magnitude, from median to 99th percentile [%]",
         "No force to compare with: see the program's output.", forceOf, &PathCost::on_force_front}};
    double left = kLeft;
    for (const Panel& panel : panels) {
        drawPanel(svg, panel, result.rows, left);
        left += kPitch;
    }
    drawLegend(svg);
    return svg.take();
}

}  // namespace passung::truth
