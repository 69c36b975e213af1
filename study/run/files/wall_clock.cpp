#include "study/run/files/wall_clock.h"

#include <chrono>

namespace passung::run {

std::int64_t unixMilliseconds() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

store::OpenOptions openOptionsNow(std::int64_t unix_ms) {
    store::OpenOptions options;
    options.app_version = PASSUNG_VERSION;
    options.now_utc = store::UtcClock::wall(unix_ms).at(0);
    return options;
}

}  // namespace passung::run
