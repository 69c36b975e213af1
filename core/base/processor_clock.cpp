#include "core/base/processor_clock.h"

#include <time.h>

namespace passung {

std::int64_t threadProcessorNanoseconds() noexcept {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

}  // namespace passung
