#include "analysis/truth/svg.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace passung::truth {

namespace {

constexpr double kLabelStep = 17;  // [px]

std::string outline(double x, double y, double r, PlotMark mark) {
    using Corners = std::vector<std::array<double, 2>>;
    const Corners corners = mark == PlotMark::Square    ? Corners{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}
                            : mark == PlotMark::Up      ? Corners{{0, -1.3}, {1.2, 0.9}, {-1.2, 0.9}}
                            : mark == PlotMark::Diamond ? Corners{{0, -1.25}, {1.25, 0}, {0, 1.25}, {-1.25, 0}}
                                                        : Corners{{-1.2, -0.9}, {1.2, -0.9}, {0, 1.3}};
    std::string points;
    for (const auto& [right, down] : corners) points += fmt::format("{:.1f},{:.1f} ", x + r * right, y + r * down);
    return points;
}

}  // namespace

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

Svg::Svg(double width, double height) {
    add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
        R"(font-family="Liberation Sans, DejaVu Sans, Arial, sans-serif">)",
        width, height);
    add(R"(<rect width="{}" height="{}" fill="#FFFFFF"/>)", width, height);
}

void Svg::text(double x, double y, const std::string& words, const char* style, const char* anchor) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" style="{}">{}</text>)", x, y, anchor, style, escaped(words));
}

void Svg::line(double x1, double y1, double x2, double y2, const char* colour, double width) {
    add(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{}"/>)", x1, y1, x2, y2,
        colour, width);
}

void Svg::mark(double x, double y, double r, PlotMark mark, const std::string& fill, double opacity,
               const char* stroke) {
    const std::string style =
        fmt::format(R"(fill="{}" fill-opacity="{}" stroke="{}" stroke-width="1.2")", fill, opacity, stroke);
    if (mark == PlotMark::Disc)
        add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" {}/>)", x, y, r, style);
    else
        add(R"(<polygon points="{}" {}/>)", outline(x, y, r, mark), style);
}

std::string Svg::take() {
    add("</svg>");
    return std::move(text_);
}

double PlotAxis::at(double value) const {
    return at_low + (at_high - at_low) * std::log(value / low) / std::log(high / low);
}

std::vector<double> PlotAxis::ticks() const {
    std::vector<double> all;
    const bool few = std::log10(high / low) > 3.2;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0)
        for (const double step : few ? std::vector{1.0} : std::vector{1.0, 2.0, 5.0})
            if (step * decade >= low * 0.999 && step * decade <= high * 1.001) all.push_back(step * decade);
    return all;
}

PlotAxis axisAround(double low, double high, double at_low, double at_high) {
    return {low / 1.35, high * 1.35, at_low, at_high};
}

void drawAxes(Svg& svg, const PlotAxis& x, const PlotAxis& y, const std::string& x_label, const std::string& y_label) {
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
    svg.text(0.5 * (x.at_low + x.at_high), y.at_low + 43, x_label, kPlain, "middle");
    const double middle = 0.5 * (y.at_low + y.at_high);
    svg.add(R"svg(<text transform="translate({:.1f} {:.1f}) rotate(-90)" text-anchor="middle" style="{}">{}</text>)svg",
            x.at_low - 56, middle, kPlain, escaped(y_label));
}

void drawLabels(Svg& svg, const std::vector<PlotLabel>& labels, const PlotAxis& x, const PlotAxis& y) {
    const double column = x.at_high + 22;
    double next = y.at_high + 6;
    std::vector<double> places;
    for (const PlotLabel& label : labels) {
        places.push_back(std::max(next, label.y));
        next = places.back() + kLabelStep;
    }
    // Those that went below the panel push the others up.
    double limit = y.at_low - 2;
    for (std::size_t i = places.size(); i-- > 0;) {
        places[i] = std::min(places[i], limit);
        limit = places[i] - kLabelStep;
    }
    for (std::size_t i = 0; i < labels.size(); ++i) {
        svg.add(R"(<polyline points="{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}" fill="none" stroke="{}" )"
                R"(stroke-width="0.8" stroke-opacity="0.55"/>)",
                labels[i].x, labels[i].y, x.at_high + 4, places[i], column - 4, places[i], kQuiet);
        svg.text(column, places[i] + 4, labels[i].words, kSmall);
    }
}

}  // namespace passung::truth
