#include "analysis/truth/accuracy_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "analysis/truth/accuracy_tables.h"

namespace passung::truth {

namespace {

// Okabe and Ito's colours, told apart by colour-blind people too.
constexpr std::array kColours{"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"};
constexpr const char *kInk = "#222222", *kFaint = "#E3E3E3", *kQuiet = "#666666", *kFront = "#222222";
constexpr double kWidth = 1400, kHeight = 730;
constexpr double kTop = 132, kPlotHeight = 450, kPlotWidth = 360, kLeft = 78, kPitch = 690;
constexpr double kLabelStep = 17;
constexpr double kLeastShare = 1e-3;  // an error of nothing at all is drawn at this share of the smallest other one

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else
            result += c;
    }
    return result;
}

std::string titleOf(const PictureText& text) {
    return "What accuracy costs in time: " + text.shell + " against " + text.field;
}

class Svg {
public:
    template <class... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
        text_ += '\n';
    }
    void text(double x, double y, const std::string& words, const char* style, const char* anchor = "start") {
        add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" style="{}">{}</text>)", x, y, anchor, style,
            escaped(words));
    }
    void line(double x1, double y1, double x2, double y2, const char* colour, double width) {
        add(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{}"/>)", x1, y1, x2, y2,
            colour, width);
    }
    /// Trilinear: a disc; the others: polygons.
    void mark(double x, double y, double r, field::FieldMode mode, const std::string& fill, double opacity,
              const char* stroke) {
        const std::string style =
            fmt::format(R"(fill="{}" fill-opacity="{}" stroke="{}" stroke-width="1.2")", fill, opacity, stroke);
        if (mode == field::FieldMode::Trilinear)
            add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" {}/>)", x, y, r, style);
        else
            add(R"(<polygon points="{}" {}/>)", outline(x, y, r, mode), style);
    }
    std::string take() { return std::move(text_); }

private:
    static std::string outline(double x, double y, double r, field::FieldMode mode) {
        using Corners = std::vector<std::array<double, 2>>;
        const Corners corners = mode == field::FieldMode::Layered        ? Corners{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}
                                : mode == field::FieldMode::SurfacePoint ? Corners{{0, -1.3}, {1.2, 0.9}, {-1.2, 0.9}}
                                : mode == field::FieldMode::Linear
                                    ? Corners{{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}}
                                    : Corners{{-1.2, -0.9}, {1.2, -0.9}, {0, 1.3}};
        std::string points;
        for (const auto& [right, down] : corners) points += fmt::format("{:.1f},{:.1f} ", x + r * right, y + r * down);
        return points;
    }

    std::string text_;
};

constexpr const char* kTitle = "font-size:21px;font-weight:bold;fill:#222222";
constexpr const char* kHeading = "font-size:15px;font-weight:bold;fill:#222222";
constexpr const char* kPlain = "font-size:13px;fill:#222222";
constexpr const char* kSmall = "font-size:12px;fill:#444444";

/// A logarithmic axis from low to high, laid on pixels from `at_low` to `at_high`.
struct Axis {
    double low, high, at_low, at_high;
    double at(double value) const { return at_low + (at_high - at_low) * std::log(value / low) / std::log(high / low); }
    /// 1, 2 and 5 of every decade; only the decades if there are many.
    std::vector<double> ticks() const {
        std::vector<double> all;
        const bool few = std::log10(high / low) > 3.2;
        for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
            for (const double step : few ? std::vector{1.0} : std::vector{1.0, 2.0, 5.0})
                if (step * decade >= low * 0.999 && step * decade <= high * 1.001) all.push_back(step * decade);
        return all;
    }
};

Axis axisAround(double low, double high, double at_low, double at_high) {
    return {low / 1.35, high * 1.35, at_low, at_high};
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
    return kColours[static_cast<std::size_t>(place) % kColours.size()];
}

void drawAxes(Svg& svg, const Axis& x, const Axis& y, const char* label) {
    for (const double value : x.ticks()) {
        svg.line(x.at(value), y.at_low, x.at(value), y.at_high, kFaint, 1);
        svg.text(x.at(value), y.at_low + 20, fmt::format("{:g}", value), kPlain, "middle");
    }
    for (const double value : y.ticks()) {
        svg.line(x.at_low, y.at(value), x.at_high, y.at(value), kFaint, 1);
        svg.text(x.at_low - 8, y.at(value) + 4.5, fmt::format("{:g}", value), kPlain, "end");
    }
    svg.line(x.at_low, y.at_low, x.at_high, y.at_low, kInk, 1.2);
    svg.line(x.at_low, y.at_low, x.at_low, y.at_high, kInk, 1.2);
    svg.text(0.5 * (x.at_low + x.at_high), y.at_low + 43, "time of a tick's query, 99th percentile [µs]", kPlain,
             "middle");
    const double middle = 0.5 * (y.at_low + y.at_high);
    svg.add(R"svg(<text transform="translate({:.1f} {:.1f}) rotate(-90)" text-anchor="middle" style="{}">{}</text>)svg",
            x.at_low - 56, middle, kPlain, escaped(label));
}

/// The settings of the front in a column to its right, in the order of their errors, each tied to its mark.
void drawLabels(Svg& svg, const std::vector<const SettingCost*>& front, const Axis& x, const Axis& y,
                const std::function<double(const SettingCost&)>& shown) {
    const double column = x.at_high + 22;
    double next = y.at_high + 6;
    std::vector<double> places;
    for (const SettingCost* row : front) {
        places.push_back(std::max(next, y.at(shown(*row))));
        next = places.back() + kLabelStep;
    }
    // Those that went below the panel push the others up.
    double limit = y.at_low - 2;
    for (std::size_t i = places.size(); i-- > 0;) {
        places[i] = std::min(places[i], limit);
        limit = places[i] - kLabelStep;
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
        const double px = x.at(timeOf(*front[i])), py = y.at(shown(*front[i]));
        svg.add(R"(<polyline points="{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}" fill="none" stroke="{}" )"
                R"(stroke-width="0.8" stroke-opacity="0.55"/>)",
                px, py, x.at_high + 4, places[i], column - 4, places[i], kQuiet);
        svg.text(column, places[i] + 4, settingText(front[i]->setting), kSmall);
    }
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
    const Axis x = axisAround(fast, slow, left, left + kPlotWidth);
    const Axis y = axisAround(low, high, kTop + kPlotHeight, kTop);
    const auto shown = [&](const SettingCost& row) { return std::max(low, panel.error(row)); };
    drawAxes(svg, x, y, panel.axis);

    std::vector<const SettingCost*> front;
    for (const SettingCost& row : rows) {
        if (!std::isfinite(panel.error(row))) continue;
        if (row.*panel.front)
            front.push_back(&row);
        else
            svg.mark(x.at(timeOf(row)), y.at(shown(row)), 3.6, row.setting.mode,
                     colourOf(spacings, row.setting.spacing), row.setting.budget_nodes > 0 ? 0.12 : 0.55,
                     colourOf(spacings, row.setting.spacing).c_str());
    }
    std::sort(front.begin(), front.end(),
              [](const SettingCost* a, const SettingCost* b) { return a->time.p99 < b->time.p99; });
    drawLabels(svg, front, x, y, shown);
    std::string path;
    for (const SettingCost* row : front) path += fmt::format("{:.1f},{:.1f} ", x.at(timeOf(*row)), y.at(shown(*row)));
    svg.add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.8"/>)", path, kFront);
    for (const SettingCost* row : front)
        svg.mark(x.at(timeOf(*row)), y.at(shown(*row)), 6, row->setting.mode, colourOf(spacings, row->setting.spacing),
                 1.0, kFront);
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
        svg.mark(x, y, 6, field::FieldMode::Trilinear, colour, 1.0, colour.c_str());
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
        svg.mark(x, y, 6, mode, "#FFFFFF", 1.0, kInk);
        x += 13;
        const std::string name = field::modeName(mode);
        word(name, 24 + 6.5 * static_cast<double>(name.size()));
    }
    x += 22;
    svg.mark(x, y, 4, field::FieldMode::Trilinear, kInk, 0.12, kInk);
    x += 12;
    word("pale: with a node budget", 0);
    x = kLeft;
    y += 30;
    svg.line(x, y, x + 30, y, kFront, 1.8);
    svg.mark(x + 15, y, 6, field::FieldMode::Trilinear, "#FFFFFF", 1.0, kFront);
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
    Svg svg;
    svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
            R"(font-family="Liberation Sans, DejaVu Sans, Arial, sans-serif">)",
            kWidth, kHeight);
    svg.add(R"(<rect width="{}" height="{}" fill="#FFFFFF"/>)", kWidth, kHeight);
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
    svg.add("</svg>");
    return svg.take();
}

}  // namespace passung::truth
