#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace passung::truth {

// What the pictures of accuracy over time are drawn with.

// Okabe and Ito's colours, told apart by colour-blind people too.
inline constexpr const char* kColours[] = {"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"};
inline constexpr const char *kInk = "#222222", *kFaint = "#E3E3E3", *kQuiet = "#666666";
inline constexpr const char* kTitle = "font-size:21px;font-weight:bold;fill:#222222";
inline constexpr const char* kHeading = "font-size:15px;font-weight:bold;fill:#222222";
inline constexpr const char* kPlain = "font-size:13px;fill:#222222";
inline constexpr const char* kSmall = "font-size:12px;fill:#444444";

enum class PlotMark { Disc, Square, Up, Diamond, Down };

/// Text for XML.
std::string escaped(const std::string& text);

class Svg {
public:
    /// A white page of this size [px].
    Svg(double width, double height);

    template <class... Args>
    void add(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
        text_ += '\n';
    }
    void text(double x, double y, const std::string& words, const char* style, const char* anchor = "start");
    void line(double x1, double y1, double x2, double y2, const char* colour, double width);
    void mark(double x, double y, double r, PlotMark mark, const std::string& fill, double opacity, const char* stroke);
    /// Ends the page.
    std::string take();

private:
    std::string text_;
};

/// A logarithmic axis from low to high, laid on pixels from `at_low` to `at_high`.
struct PlotAxis {
    double low, high, at_low, at_high;
    double at(double value) const;
    /// 1, 2 and 5 of every decade; only the decades if there are many.
    std::vector<double> ticks() const;
};
PlotAxis axisAround(double low, double high, double at_low, double at_high);

/// Lines, numbers, and what the axes are.
void drawAxes(Svg& svg, const PlotAxis& x, const PlotAxis& y, const std::string& x_label, const std::string& y_label);

/// Labels in a column right of a plot, in the order of their heights, each tied to its mark. `y` [px].
struct PlotLabel {
    double x, y;
    std::string words;
};
void drawLabels(Svg& svg, const std::vector<PlotLabel>& labels, const PlotAxis& x, const PlotAxis& y);

}  // namespace passung::truth
