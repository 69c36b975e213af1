#pragma once

#include <cstdint>
#include <optional>

#include "core/loop/mailbox.h"
#include "core/loop/record_ring.h"
#include "core/loop/timing.h"

namespace passung::app {

/// How old the pictures of one attempt were when the display got them: from the reading of the device for the newest
/// tick that a picture shows.
struct FrameTimes {
    std::int64_t first_ns = 0;  // when the first tick that was shown began, on the steady clock
    loop::TimingHistogram age;
};

/// Measures that. Three threads meet here and none waits: the window's items are moved in one, drawn in another (or the
/// same), and the session asks from a third.
class FrameClock {
public:
    /// The items stand as in this tick from now on. The items' thread.
    void show(const loop::ScreenTick& tick);
    /// A picture is being taken of the items, whose thread waits. The thread that draws.
    void take();
    /// The display has got that picture. The thread that draws.
    void present(std::int64_t now_ns);

    /// Of the newest attempt, if its pictures show ticks from `since_ns` on; none: nothing of it was shown. The
    /// session's thread.
    std::optional<FrameTimes> timesSince(std::int64_t since_ns);

private:
    struct Shown {
        std::int64_t tick = -1, began_ns = 0, attempt = 0;
    };
    Shown items_, picture_, display_;
    FrameTimes times_;
    loop::Mailbox<FrameTimes> box_{FrameTimes{}};
};

/// The steady clock [ns].
std::int64_t steadyNanoseconds();

}  // namespace passung::app
