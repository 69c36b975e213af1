#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace passung::store {

enum class Epoch { Virtual, Wall };

/// Turns a session's monotonic time into UTC text, and what happens now into a stamp.
class UtcClock {
public:
    using Now = std::function<std::int64_t()>;  // UTC by the machine's clock, in milliseconds since 1970

    /// Time at which something happened. Stamps of one clock never go backwards.
    struct Stamp {
        std::string utc;
        std::string machine_utc;  // what the machine's clock says, if it was set back before `utc` since the last stamp
    };

    /// Simulated sessions: time zero is 2000-01-01T00:00:00Z, so that no wall clock reaches their data.
    static UtcClock virtualEpoch() { return {Epoch::Virtual, 946'684'800'000}; }
    /// `unix_ms`: UTC at the segment's monotonic zero, in milliseconds since 1970.
    static UtcClock wall(std::int64_t unix_ms) { return {Epoch::Wall, unix_ms}; }
    /// Sessions in real time, where pauses and questionnaires take time too: stamps are read from `now`. The session is
    /// `used_ns` old, and none of its stamps is earlier than `not_before`.
    static UtcClock running(Now now, std::int64_t used_ns = 0, std::string not_before = {});

    Epoch epoch() const { return epoch_; }
    /// UTC `t_ns` after zero as `2000-01-01T00:00:12.345Z`.
    std::string at(std::int64_t t_ns) const;
    /// Tells whether the wall clock is read at every stamp.
    bool runs() const { return static_cast<bool>(now_); }
    /// Stamp of what happens now, at session time `t_ns`, which decides where no clock runs.
    Stamp stamp(std::int64_t t_ns);

private:
    UtcClock(Epoch epoch, std::int64_t unix_ms) : epoch_(epoch), unix_ms_(unix_ms) {}

    Epoch epoch_;
    std::int64_t unix_ms_;
    Now now_;
    std::string latest_;   // stamp
    bool behind_ = false;  // the machine's clock lies before it
};

}  // namespace passung::store
