#include "study/store/schema/utc_clock.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <utility>

namespace passung::store {

UtcClock UtcClock::running(Now now, std::int64_t used_ns, std::string not_before) {
    UtcClock clock = wall(now() - used_ns / 1'000'000);
    clock.now_ = std::move(now);
    clock.latest_ = std::move(not_before);
    return clock;
}

UtcClock::Stamp UtcClock::stamp(std::int64_t t_ns) {
    if (!runs()) return {at(t_ns), {}};
    Stamp stamp{wall(now_()).at(0), {}};
    const bool was_behind = std::exchange(behind_, stamp.utc < latest_);  // such texts sort as their times
    if (behind_) {
        if (!was_behind) stamp.machine_utc = stamp.utc;
        stamp.utc = latest_;
    }
    latest_ = stamp.utc;
    return stamp;
}

std::string UtcClock::at(std::int64_t t_ns) const {
    using namespace std::chrono;
    const sys_time<milliseconds> time{milliseconds(unix_ms_) + floor<milliseconds>(nanoseconds(t_ns))};
    const auto midnight = floor<days>(time);
    const year_month_day date{midnight};
    const hh_mm_ss clock{time - midnight};
    std::array<char, 64> text{};
    const int length =
        std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ", static_cast<int>(date.year()),
                      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                      static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                      static_cast<int>(clock.seconds().count()), static_cast<int>(clock.subseconds().count()));
    return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace passung::store
