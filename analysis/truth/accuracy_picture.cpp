#include "analysis/truth/accuracy_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "analysis/truth/accuracy_tables.h"
#include "analysis/truth/svg.h"

namespace passung::truth {

namespace {

constexpr const char* kFront = kInk;
constexpr double kWidth = 1400, kHeight = 730;
constexpr double kTop = 132, kPlotHeight = 450, kPlotWidth = 360, kLeft = 78, kPitch = 690;
constexpr double kLeastShare = 1e-3;  // an error of nothing at all is drawn at this share of the smallest other one

std::string titleOf(const PictureText& text) {
    return "What accuracy costs in time: " + text.shell + " against " + text.field;
}

/// Trilinear: a disc; the others: polygons.
PlotMark markOf(field::FieldMode mode) {
    return mode == field::FieldMode::Trilinear      ? PlotMark::Disc
           : mode == field::FieldMode::Layered      ? PlotMark::Square
           : mode == field::FieldMode::SurfacePoint ? PlotMark::Up
           : mode == field::FieldMode::Linear       ? PlotMark::Diamond
                                                    : PlotMark::Down;
}

struct Panel {
    const char* title;
    const char* axis;
    std::function<double(const SettingCost&)> error;
    bool SettingCost::*front;
};

double timeOf(const SettingCost& row) { return 1e6 * row.time.p99; }

std::vector<double> spacingsOf(const std::vector<SettingCost>& rows) {
    std::vector<double> spacings;
    for (const SettingCost& row : rows) spacings.push_back(row.setting.spacing);
    std::sort(spacings.begin(), spacings.end(), std::greater<>());
    spacings.erase(std::unique(spacings.begin(), spacings.end()), spacings.end());
    return spacings;
}

std::string colourOf(const std::vector<double>& spacings, double spacing) {
    const auto place = std::find(spacings.begin(), spacings.end(), spacing) - spacings.begin();
    return kColours[static_cast<std::size_t>(place) % std::size(kColours)];
}

/// The settings of the front beside their marks.
void drawFrontLabels(Svg& svg, const std::vector<const SettingCost*>& front, const PlotAxis& x, const PlotAxis& y,
                     const std::function<double(const SettingCost&)>& shown) {
    std::vector<PlotLabel> labels;
    for (const SettingCost* row : front)
        labels.push_back({x.at(timeOf(*row)), y.at(shown(*row)), settingText(row->setting)});
    drawLabels(svg, labels, x, y);
}

void drawPanel(Svg& svg, const Panel& panel, const std::vector<SettingCost>& rows, const std::vector<double>& spacings,
               double left) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0, fast = low, slow = 0.0;
    for (const SettingCost& row : rows) {
        const double error = panel.error(row);
        if (!std::isfinite(error)) continue;
        fast = std::min(fast, timeOf(row));
        slow = std::max(slow, timeOf(row));
        high = std::max(high, error);
        if (error > 0.0) low = std::min(low, error);
    }
    svg.text(left, kTop - 16, panel.title, kHeading);
    if (!(high > 0.0)) {
        svg.text(left, kTop + 30, "No pose of this kind, or no error at all.", kPlain);
        return;
    }
    low = std::max(low, kLeastShare * high);
    const PlotAxis x = axisAround(fast, slow, left, left + kPlotWidth);
    const PlotAxis y = axisAround(low, high, kTop + kPlotHeight, kTop);
    const auto shown = [&](const SettingCost& row) { return std::max(low, panel.error(row)); };
    drawAxes(svg, x, y, "time of a tick's query, 99th percentile [µs]", panel.axis);

    std::vector<const SettingCost*> front;
    for (const SettingCost& row : rows) {
        if (!std::isfinite(panel.error(row))) continue;
        if (row.*panel.front)
            front.push_back(&row);
        else
            svg.mark(x.at(timeOf(row)), y.at(shown(row)), 3.6, markOf(row.setting.mode),
                     colourOf(spacings, row.setting.spacing), row.setting.budget_nodes > 0 ? 0.12 : 0.55,
                     colourOf(spacings, row.setting.spacing).c_str());
    }
    std::sort(front.begin(), front.end(),
              [](const SettingCost* a, const SettingCost* b) { return a->time.p99 < b->time.p99; });
    drawFrontLabels(svg, front, x, y, shown);
    std::string path;
    for (const SettingCost* row : front) path += fmt::format("{:.1f},{:.1f} ", x.at(timeOf(*row)), y.at(shown(*row)));
    svg.add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.8"/>)", path, kFront);
    for (const SettingCost* row : front)
        svg.mark(x.at(timeOf(*row)), y.at(shown(*row)), 6, markOf(row->setting.mode),
                 colourOf(spacings, row->setting.spacing), 1.0, kFront);
}

void drawLegend(Svg& svg, const std::vector<SettingCost>& rows, const std::vector<double>& spacings) {
    double x = kLeft, y = kHeight - 66;
    const auto word = [&](const std::string& text, double width) {
        svg.text(x, y + 4.5, text, kPlain);
        x += width;
    };
    word("points of the shell, apart:", 180);
    for (const double spacing : spacings) {
        const std::string colour = colourOf(spacings, spacing);
        svg.mark(x, y, 6, PlotMark::Disc, colour, 1.0, colour.c_str());
        x += 12;
        const std::string text = fmt::format("{:g} mm", 1e3 * spacing);
        word(text, 24 + 7.5 * static_cast<double>(text.size()));
    }
    x += 22;
    word("interpolation of the field:", 182);
    for (const field::FieldMode mode : field::kFieldModes) {
        const bool used =
            std::any_of(rows.begin(), rows.end(), [&](const SettingCost& row) { return row.setting.mode == mode; });
        if (!used) continue;
        svg.mark(x, y, 6, markOf(mode), "#FFFFFF", 1.0, kInk);
        x += 13;
        const std::string name = field::modeName(mode);
        word(name, 24 + 6.5 * static_cast<double>(name.size()));
    }
    x += 22;
    svg.mark(x, y, 4, PlotMark::Disc, kInk, 0.12, kInk);
    x += 12;
    word("pale: with a node budget", 0);
    x = kLeft;
    y += 30;
    svg.line(x, y, x + 30, y, kFront, 1.8);
    svg.mark(x + 15, y, 6, PlotMark::Disc, "#FFFFFF", 1.0, kFront);
    x += 42;
    word(
        "Pareto front: no other setting is both faster and nearer the truth. Beside it: tolerance of the field, "
        "points apart, interpolation, node budget.",
        0);
}

}  // namespace

bool isPictureOf(const std::string& picture, const PictureText& text) {
    return picture.find(">" + escaped(titleOf(text)) + "</text>") != std::string::npos;
}

std::string accuracyPicture(const std::vector<SettingCost>& rows, const PictureText& text) {
    Svg svg(kWidth, kHeight);
    svg.text(kLeft - 56, 38, titleOf(text), kTitle);
    svg.text(
        kLeft - 56, 64,
        fmt::format("{} settings, each asked the same {} poses ({} in contact), beside independent truth. Lower is "
                    "nearer the truth, further left is faster; every error is its 99th percentile.",
                    rows.size(), text.poses, text.contacts),
        kPlain);
    const std::vector<double> spacings = spacingsOf(rows);
    const std::array panels{
        Panel{"Depth in contact", "error of the depth [µm]", [](const SettingCost& row) { return 1e6 * row.depth.p99; },
              &SettingCost::on_depth_front},
        Panel{"Force in contact (poses with at least 1 % of the largest force)", "error of the force's magnitude [%]",
              [](const SettingCost& row) { return 100.0 * row.force.p99; }, &SettingCost::on_force_front}};
    for (std::size_t i = 0; i < panels.size(); ++i)
        drawPanel(svg, panels[i], rows, spacings, kLeft + static_cast<double>(i) * kPitch);
    drawLegend(svg, rows, spacings);
    return svg.take();
}

}  // namespace passung::truth
