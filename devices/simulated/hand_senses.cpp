#include "devices/simulated/hand_senses.h"

#include <algorithm>
#include <cmath>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

std::int64_t ticks(double seconds) { return std::llround(seconds / kTickSeconds); }

}  // namespace

HandSenses::HandSenses(const HandParams& params, std::uint64_t cues)
    : haptic_delay_ticks_(ticks(params.haptic_delay)),
      visual_delay_ticks_(ticks(params.visual_delay)),
      colour_(params.visual_cue, splitmix64(cues)),
      vibration_(params.vibration_cue, splitmix64(cues)),
      sound_(params.sound_cue, splitmix64(cues)) {}

void HandSenses::feel(const Pose& X_WH, const Wrench& F_W) noexcept {
    ++now_;
    feelings_[static_cast<std::size_t>(now_) % kMemory] = {X_WH, F_W};
}

void HandSenses::regrip(const Pose& X_HN) noexcept {
    for (Feeling& feeling : feelings_) feeling.X_WH = feeling.X_WH * X_HN;
}

void HandSenses::see(const loop::DisplayedImage& image) noexcept {
    sights_[static_cast<std::size_t>(sights_seen_) % kMemory] = {std::max<std::int64_t>(now_, 0), image};
    ++sights_seen_;
}

void HandSenses::notice(const GivenCues& cues) noexcept {
    colour_.give(cues.visual);
    vibration_.give(cues.vibration);
    sound_.give(cues.sound);
}

Percept HandSenses::percept() const noexcept {
    Percept percept;
    if (now_ < 0) return percept;
    const std::int64_t felt = std::max<std::int64_t>(now_ - haptic_delay_ticks_, 0);
    percept.X_WFelt = feelings_[static_cast<std::size_t>(felt) % kMemory].X_WH;
    percept.F_felt = feelings_[static_cast<std::size_t>(felt) % kMemory].F_W;
    percept.cue = std::max(colour_.perceived(), vibration_.perceived());
    percept.knock = sound_.perceived() > 0.0;
    const std::int64_t oldest = std::max<std::int64_t>(sights_seen_ - static_cast<std::int64_t>(kMemory), 0);
    for (std::int64_t i = sights_seen_ - 1; i >= oldest; --i) {
        const Sight& sight = sights_[static_cast<std::size_t>(i) % kMemory];
        if (sight.arrived > now_ - visual_delay_ticks_) continue;
        percept.sees = true;
        percept.X_WSeen = sight.image.X_WShown;
        percept.X_WHeld = sight.image.X_WHeld;
        percept.held = sight.image.held;
        percept.at_rest = sight.image.at_rest;
        percept.steps_done = sight.image.steps_done;
        percept.go = sight.image.running;
        break;
    }
    return percept;
}

}  // namespace passung::simulated
