#include "study/store/utc_clock.h"

#include <array>
#include <chrono>
#include <cstdio>

namespace passung::store {

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
