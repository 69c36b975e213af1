#include "devices/simulated/cue_channel.h"

#include <algorithm>
#include <cmath>

#include "core/base/tick_record.h"

namespace passung::simulated {

CueChannel::CueChannel(const CueSense& sense, std::uint64_t seed)
    : sense_(sense), random_(seed), delay_ticks_(std::llround(sense.delay / kTickSeconds)) {}

void CueChannel::give(double command) noexcept {
    double strength = 0.0;
    if (command > 0.0) {
        if (given_for_++ % kGlimpse == 0) gain_ = std::exp(sense_.noise * random_.normal());
        strength = command * gain_;
        strength = strength >= sense_.threshold ? std::min(strength, 1.0) : 0.0;
    } else {
        given_for_ = 0;
    }
    ++now_;
    strengths_[static_cast<std::size_t>(now_) % kMemory] = strength;
}

double CueChannel::perceived() const noexcept {
    const std::int64_t then = now_ - delay_ticks_;
    return then < 0 ? 0.0 : strengths_[static_cast<std::size_t>(then) % kMemory];
}

}  // namespace passung::simulated
