#pragma once

#include <cstdint>
#include <string>

namespace passung::store {

enum class Epoch { Virtual, Wall };

/// Turns a session's monotonic time into UTC text. The wall clock is read once by whoever makes it, never here.
class UtcClock {
public:
    /// Simulated sessions: time zero is 2000-01-01T00:00:00Z, so that no wall clock reaches their data.
    static UtcClock virtualEpoch() { return {Epoch::Virtual, 946'684'800'000}; }
    /// `unix_ms`: UTC at the segment's monotonic zero, in milliseconds since 1970.
    static UtcClock wall(std::int64_t unix_ms) { return {Epoch::Wall, unix_ms}; }

    Epoch epoch() const { return epoch_; }
    /// UTC `t_ns` after zero as `2000-01-01T00:00:12.345Z`.
    std::string at(std::int64_t t_ns) const;

private:
    UtcClock(Epoch epoch, std::int64_t unix_ms) : epoch_(epoch), unix_ms_(unix_ms) {}

    Epoch epoch_;
    std::int64_t unix_ms_;
};

}  // namespace passung::store
