#include "ui/app/frame_clock.h"

#include <chrono>

namespace passung::app {

void FrameClock::show(const loop::ScreenTick& tick) {
    if (tick.record.tick < items_.tick) ++items_.attempt;
    items_.tick = tick.record.tick;
    items_.began_ns = tick.began_ns;
}

void FrameClock::take() { picture_ = items_; }

void FrameClock::present(std::int64_t now_ns) {
    if (picture_.began_ns == display_.began_ns) return;  // the same tick once more
    if (picture_.attempt != display_.attempt || times_.age.count() == 0) times_ = {picture_.began_ns, {}};
    display_ = picture_;
    times_.age.add(now_ns - picture_.began_ns);
    box_.put(times_);
}

std::optional<FrameTimes> FrameClock::timesSince(std::int64_t since_ns) {
    const FrameTimes& newest = box_.latest();
    if (newest.age.count() == 0 || newest.first_ns < since_ns) return std::nullopt;
    return newest;
}

std::int64_t steadyNanoseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace passung::app
