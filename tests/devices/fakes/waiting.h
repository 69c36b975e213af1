#pragma once

#include <poll.h>

#include <stdexcept>
#include <string>

namespace passung::fake {

constexpr int kSliceMs = 20;           // [ms] between two looks at what a poll does not report
constexpr int kMostIdleSlices = 3000;  // without any progress: a minute, which only what hangs reaches

/// Calls `step` until it says that it is done. `step` waits by itself, at most a slice, and returns whether anything
/// has moved; the limit counts slices since the last progress. Throws with `what` beyond it.
template <typename Step, typename Done>
void waitFor(const std::string& what, Step step, Done done) {
    for (int idle = 0; !done();) {
        idle = step() ? 0 : idle + 1;
        if (idle > kMostIdleSlices) throw std::runtime_error("waited in vain for " + what);
    }
}

/// Is there something to read, or has the other end gone, within a slice?
inline bool readable(int descriptor, int milliseconds = kSliceMs) {
    pollfd entry{descriptor, POLLIN, 0};
    return poll(&entry, 1, milliseconds) > 0;
}

}  // namespace passung::fake
