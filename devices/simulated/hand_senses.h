#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"
#include "core/loop/haptic_device.h"
#include "devices/simulated/cue_channel.h"
#include "devices/simulated/hand_params.h"

namespace passung::simulated {

/// What the person knows at one moment, all of it late.
struct Percept {
    Pose X_WFelt;                                 // where the own posture says the held part is
    Wrench F_felt;                                // on the hand, about the handle's origin, world axes
    bool sees = false;                            // an image has arrived
    Pose X_WSeen;                                 // the held part as drawn
    std::array<Pose, scene::kMostHands> X_WHeld;  // each hand's, DisplayedImage::X_WHeld
    // Which part each hand holds, which part lies where, what of an assembly is done: as in DisplayedImage.
    std::array<std::int32_t, scene::kMostHands> held = loop::DisplayedImage::nobodyHolds();
    tick::PartAtRest at_rest = {};
    std::uint64_t steps_done = 0;
    bool go = false;     // the trial has visibly started
    double cue = 0.0;    // contact as colour and vibration tell of it, from 0 (they do not) to 1
    bool knock = false;  // an impact is heard
};

/// Delays between the world and the person. rt-safe after construction.
class HandSenses {
public:
    /// `cues`: seed of what is random in perceiving these.
    HandSenses(const HandParams& params, std::uint64_t cues);
    /// One call per tick, before percept().
    void feel(const Pose& X_WH, const Wrench& F_W) noexcept;
    /// What was felt of the held part is from now on felt of what is at `X_HN` in its frame.
    void regrip(const Pose& X_HN) noexcept;
    void see(const loop::DisplayedImage& image) noexcept;
    void notice(const GivenCues& cues) noexcept;
    Percept percept() const noexcept;

private:
    struct Feeling {
        Pose X_WH;
        Wrench F_W;
    };
    struct Sight {
        std::int64_t arrived = 0;  // own ticks
        loop::DisplayedImage image;
    };
    static constexpr std::size_t kMemory = 512;  // > kMaxSenseDelay in ticks; images come at most once a tick

    std::int64_t haptic_delay_ticks_;
    std::int64_t visual_delay_ticks_;
    std::int64_t now_ = -1;
    std::array<Feeling, kMemory> feelings_{};
    std::array<Sight, kMemory> sights_{};
    std::int64_t sights_seen_ = 0;
    CueChannel colour_, vibration_, sound_;
};

}  // namespace passung::simulated
