#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace passung::presenter {

/// The last seconds of a signal: the smallest and the largest value of every stretch of kStretch, so that a peak of one
/// tick is seen however coarse the picture is.
class Trace {
public:
    static constexpr double kSeconds = 10.0;
    static constexpr double kStretch = 0.02;  // [s]
    struct Span {
        float low = 0.0f, high = 0.0f;
    };

    /// A value at `time` [s], which does not fall; a time before the last one begins anew.
    void add(double time, double value);
    void clear();

    /// Oldest first; the last one ends now.
    std::vector<Span> spans() const;
    /// The largest magnitude of them.
    double peak() const;

private:
    static constexpr std::size_t kCount = static_cast<std::size_t>(kSeconds / kStretch);

    std::vector<Span> ring_ = std::vector<Span>(kCount);
    std::size_t used_ = 0;
    std::int64_t newest_ = -1;  // number of the stretch, from time 0
};

/// A column of a drawn trace [px], y downwards: from the smallest to the largest value of a stretch.
struct Stroke {
    float left = 0.0f, right = 0.0f, upper = 0.0f, lower = 0.0f;
};

/// The trace of a field so large, whose upper edge stands for `top` and whose lower one for 0. Every column touches its
/// neighbours in width and in height, however steep the signal is: the line has no gap.
std::vector<Stroke> strokesOf(std::span<const Trace::Span> spans, double width, double height, double top);

/// What the upper edge stands for: 1, 2 or 5 times a power of ten, at least `least`, with a little room above `peak`.
double traceTop(double peak, double least);

}  // namespace passung::presenter
