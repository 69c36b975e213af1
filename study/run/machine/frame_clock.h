#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/loop/record_ring.h"

namespace passung::run {

/// A picture that the participant's display got, times on the steady clock.
struct Picture {
    std::int64_t began_ns = 0;      // when the device had been read for the newest tick that it shows
    std::int64_t presented_ns = 0;  // when the display got it
    bool cued = false;              // drawn with the visual cue above 0
};
using PictureRing = loop::Ring<Picture>;

/// Follows the pictures of the participant's window: which attempt they show, and how old they are. Three threads meet
/// here and none waits: the window's items are moved in one, drawn in another (or the same), and the session asks from
/// a third.
class FrameClock {
public:
    /// The items stand as before this attempt's first tick from now on, by its number from expect(). The items' thread.
    void prepared(std::int64_t attempt);
    /// The items stand as in this tick from now on; `cued`: the visual cue colours one of them. The items' thread.
    void show(const loop::ScreenTick& tick, bool cued = false);
    /// A picture is being taken of the items, whose thread waits. The thread that draws.
    void take();
    /// The display has got that picture. The thread that draws.
    void present(std::int64_t now_ns);

    /// Number for an attempt that is to be shown; no two are alike. The session's thread.
    std::int64_t expect() { return ++expected_; }
    /// Tells whether the display has had a picture of this attempt, or of a later one. The session's thread.
    bool hasShown(std::int64_t attempt) const { return shown_.load() >= attempt; }
    /// Pictures that show a newer tick than the one before, the oldest first, as many as fit, each once. The session's
    /// thread.
    std::size_t takePictures(std::span<Picture> into) { return for_session_.take(into); }
    /// The same for the items' thread.
    std::size_t takeForScreen(std::span<Picture> into) { return for_screen_.take(into); }

private:
    struct Shown {
        std::int64_t began_ns = 0;  // 0: no tick
        std::int64_t attempt = 0;
        bool cued = false;
    };
    Shown items_, picture_, display_;
    std::int64_t expected_ = 0;
    std::atomic<std::int64_t> shown_{0};
    PictureRing for_session_{4096}, for_screen_{4096};
};

/// What pictures gave between two times: how many came, how old each was when the display got it [ns], ascending, and
/// how old the oldest became before another took its place or the time was over.
struct PictureTimes {
    std::vector<std::int64_t> ages_ns;
    std::int64_t oldest_ns = 0;
    std::int64_t cued = 0;  // of them: drawn with the visual cue above 0
};

/// Ages of the pictures of an attempt whose first tick was at `zero_ns`: before the first one the screen shows the
/// scene as at that tick.
PictureTimes timesBetween(std::span<const Picture> pictures, std::int64_t zero_ns, std::int64_t from_ns,
                          std::int64_t to_ns);

/// The steady clock [ns].
std::int64_t steadyNanoseconds();

}  // namespace passung::run
