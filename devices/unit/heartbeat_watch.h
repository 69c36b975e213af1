#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace passung::unit {

/// Whether a commanded wrench may stand: the newest command is younger than the heartbeat. One that pushes and grows
/// older is withheld; if the next comes within `recovers` of it the force is ramped back, and the gap counted. Beyond
/// that, or after withhold(), none passes until who commands knows of it and has commanded zero.
class HeartbeatWatch {
public:
    using Nanoseconds = std::int64_t;
    static constexpr Nanoseconds kRamp = 50'000'000;

    HeartbeatWatch(std::chrono::nanoseconds heartbeat, std::chrono::nanoseconds recovers)
        : heartbeat_(heartbeat.count()), recovers_(recovers.count()) {}

    struct Beat {
        std::uint64_t number = 0;
        Nanoseconds at = 0;  // stamped by who commands
        bool pushes = false;
        std::uint64_t withheld_seen = 0;
    };

    /// The share of the newest command's wrench that may reach the device now, 0 … 1. rt-safe.
    double share(const Beat& newest, Nanoseconds now) noexcept {
        if (newest.number != beat_.number) {
            if (missing_ && newest.at - beat_.at > recovers_) withhold();
            if (missing_ && !latched_) {
                ++gaps_;
                back_at_ = now;
            }
            missing_ = false;
            beat_ = newest;
            if (latched_ && !newest.pushes && newest.withheld_seen == withheld_) latched_ = false;
        }
        const Nanoseconds age = now - beat_.at;
        const bool alive = beat_.number > 0 && age <= heartbeat_ && age >= -heartbeat_;
        if (!alive && beat_.pushes) missing_ = true;
        if (missing_ && age > recovers_) withhold();
        if (!alive || latched_) return 0.0;
        return back_at_ == 0 ? 1.0 : std::clamp(static_cast<double>(now - back_at_) / kRamp, 0.0, 1.0);
    }

    void withhold() noexcept {
        if (!latched_) ++withheld_;
        latched_ = true;
    }
    std::uint64_t withheld() const noexcept { return withheld_; }
    std::uint64_t gaps() const noexcept { return gaps_; }

private:
    Nanoseconds heartbeat_, recovers_;
    Beat beat_;
    bool missing_ = false, latched_ = false;
    Nanoseconds back_at_ = 0;
    std::uint64_t withheld_ = 0, gaps_ = 0;
};

}  // namespace passung::unit
