#pragma once

#include <array>
#include <cstdint>

#include "core/base/random.h"
#include "devices/simulated/hand_params.h"

namespace passung::simulated {

/// What cues stand at in a tick, each from 0 to 1: colour, vibration and loudness. 0: nothing is given.
struct GivenCues {
    double visual = 0.0;
    double vibration = 0.0;
    double sound = 0.0;
};

/// How a person perceives one cue: c · exp(noise · z) if that reaches the threshold, else nothing, at most 1, and all
/// of it late. c: what is given; z: standard normal, drawn anew for every glimpse (kGlimpse ticks) from a stream of the
/// channel's own. Where nothing is given no number is drawn. rt-safe.
class CueChannel {
public:
    CueChannel(const CueSense& sense, std::uint64_t seed);

    /// One call per tick, before perceived().
    void give(double command) noexcept;
    /// From 0 (nothing is noticed) to 1.
    double perceived() const noexcept;

private:
    static constexpr std::int64_t kGlimpse = 100;
    static constexpr std::size_t kMemory = 512;  // > kMaxSenseDelay in ticks

    CueSense sense_;
    Random random_;
    std::int64_t delay_ticks_;
    std::int64_t now_ = -1;
    std::int64_t given_for_ = 0;  // ticks on end
    double gain_ = 1.0;
    std::array<double, kMemory> strengths_{};
};

}  // namespace passung::simulated
