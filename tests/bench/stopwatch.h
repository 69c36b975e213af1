#pragma once

#include <malloc.h>
#include <time.h>

#include <cstddef>

namespace passung::bench {

/// Seconds of one of the system's clocks since it was made.
template <clockid_t clock>
class Timer {
public:
    double seconds() const { return now() - start_; }

private:
    static double now() {
        timespec t{};
        clock_gettime(clock, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    }
    double start_ = now();
};

/// Time of the calling thread on its core: what other programs do on the machine does not count.
using Stopwatch = Timer<CLOCK_THREAD_CPUTIME_ID>;
/// Time of all threads of the program on their cores.
using ProcessorTime = Timer<CLOCK_PROCESS_CPUTIME_ID>;
/// Wall time, for builds that use several threads.
using WallClock = Timer<CLOCK_MONOTONIC>;

/// Bytes that this program holds from malloc (main thread): the difference is what a peer's model takes.
inline double heapBytes() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace passung::bench
