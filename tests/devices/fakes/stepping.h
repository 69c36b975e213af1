#pragma once

#include <semaphore.h>
#include <time.h>

#include "tests/devices/fakes/waiting.h"

namespace passung::fake {

/// Waits for a semaphore, at most a slice.
inline bool taken(sem_t& semaphore) {
    timespec end{};
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_nsec += kSliceMs * 1000000L;
    end.tv_sec += end.tv_nsec / 1000000000L;
    end.tv_nsec %= 1000000000L;
    return sem_timedwait(&semaphore, &end) == 0;
}

/// Lets a vendor's thread make so many ticks and waits for the end of each: virtual time. The block has the semaphores
/// go and done, shared by processes.
template <typename Block>
void step(Block& block, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
        sem_post(&block.go);
        bool over = false;
        waitFor(
            "a tick of the vendor's thread", [&] { return over = taken(block.done); }, [&] { return over; });
    }
}

}  // namespace passung::fake
