#include "study/run/machine/frame_clock.h"

#include <algorithm>
#include <chrono>

namespace passung::run {

void FrameClock::prepared(std::int64_t attempt) { items_ = {0, attempt, false}; }

void FrameClock::show(const loop::ScreenTick& tick, bool cued) {
    items_.began_ns = tick.began_ns;
    items_.cued = cued;
}

void FrameClock::take() { picture_ = items_; }

void FrameClock::present(std::int64_t now_ns) {
    shown_.store(picture_.attempt);
    if (picture_.began_ns == display_.began_ns) return;  // the same tick once more
    display_ = picture_;
    if (picture_.began_ns == 0) return;
    const Picture picture{picture_.began_ns, now_ns, picture_.cued};
    for_session_.tryPush(picture);
    for_screen_.tryPush(picture);
}

PictureTimes timesBetween(std::span<const Picture> pictures, std::int64_t zero_ns, std::int64_t from_ns,
                          std::int64_t to_ns) {
    PictureTimes times;
    std::int64_t on_screen = zero_ns;  // the tick that is shown
    for (const Picture& picture : pictures) {
        if (picture.began_ns < zero_ns || picture.presented_ns > to_ns) continue;
        if (picture.presented_ns >= from_ns) {
            times.ages_ns.push_back(picture.presented_ns - picture.began_ns);
            if (picture.cued) ++times.cued;
            times.oldest_ns = std::max(times.oldest_ns, picture.presented_ns - on_screen);
        }
        on_screen = picture.began_ns;
    }
    times.oldest_ns = std::max(times.oldest_ns, to_ns - on_screen);
    std::sort(times.ages_ns.begin(), times.ages_ns.end());
    return times;
}

std::int64_t steadyNanoseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace passung::run
