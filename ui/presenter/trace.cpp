#include "ui/presenter/trace.h"

#include <algorithm>
#include <cmath>

#include "ui/presenter/axis.h"

namespace passung::presenter {

void Trace::clear() {
    used_ = 0;
    newest_ = -1;
}

void Trace::add(double time, double value) {
    const auto stretch = static_cast<std::int64_t>(std::floor(time / kStretch));
    if (stretch < newest_) clear();
    const auto v = static_cast<float>(value);
    const auto at = [&](std::int64_t number) -> Span& { return ring_[static_cast<std::size_t>(number) % kCount]; };
    if (stretch == newest_) {
        Span& span = at(stretch);
        span = {std::min(span.low, v), std::max(span.high, v)};
        return;
    }
    // A gap holds the value before it.
    const std::int64_t first =
        newest_ < 0 ? stretch : std::max(newest_ + 1, stretch - static_cast<std::int64_t>(kCount) + 1);
    const Span held = newest_ < 0 ? Span{v, v} : at(newest_);
    for (std::int64_t number = first; number < stretch; ++number) at(number) = held;
    used_ = std::min(kCount, used_ + static_cast<std::size_t>(newest_ < 0 ? 1 : stretch - newest_));
    at(stretch) = {v, v};
    newest_ = stretch;
}

std::vector<Trace::Span> Trace::spans() const {
    std::vector<Span> all(used_);
    for (std::size_t i = 0; i < used_; ++i)
        all[used_ - 1 - i] = ring_[static_cast<std::size_t>(newest_ - static_cast<std::int64_t>(i)) % kCount];
    return all;
}

double Trace::peak() const {
    float most = 0.0f;
    for (const Span& span : spans()) most = std::max({most, std::abs(span.low), std::abs(span.high)});
    return most;
}

std::vector<Stroke> strokesOf(std::span<const Trace::Span> spans, double width, double height, double top) {
    constexpr float kThick = 1.6f;  // of what does not change [px]
    const double step = width / (Trace::kSeconds / Trace::kStretch);
    const auto half = static_cast<float>(0.5 * std::max(step, static_cast<double>(kThick)));
    const auto yOf = [&](float value) {
        return static_cast<float>(height * (1.0 - std::clamp(static_cast<double>(value) / top, 0.0, 1.0)));
    };
    std::vector<Stroke> strokes;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const auto middle = static_cast<float>(width - step * (static_cast<double>(spans.size() - 1 - i) + 0.5));
        const Trace::Span& before = spans[i > 0 ? i - 1 : 0];
        const float upper = yOf(std::max(spans[i].high, before.low)), lower = yOf(std::min(spans[i].low, before.high));
        const float more = std::max(0.0f, 0.5f * (kThick - (lower - upper)));
        strokes.push_back({middle - half, middle + half, upper - more, lower + more});
    }
    return strokes;
}

double traceTop(double peak, double least) { return roundScale(std::max(least, 1.08 * peak)); }

}  // namespace passung::presenter
