#pragma once

#include <cstdint>
#include <memory>

#include "core/loop/haptic_device.h"
#include "devices/simulated/cue_channel.h"
#include "devices/simulated/device_dynamics.h"
#include "devices/simulated/hand_params.h"

namespace passung::simulated {

/// A simulated person's hand at some task. It knows its posture, the displayed force and the displayed image, each
/// late. All but making it rt-safe; the same seed gives the same movements bit for bit.
class TaskHand {
public:
    virtual ~TaskHand() = default;

    /// A frame on the display.
    virtual void see(const loop::DisplayedImage& image) noexcept = 0;

    /// What cues the person was given in the tick that is over; call in every tick in which any may be.
    virtual void notice(const GivenCues& cues) noexcept = 0;

    /// One tick: posture and force in, what the arm does out. `F_D_B` as the motors give it.
    virtual HandCoupling act(const Pose& X_BD, const Wrench& F_D_B) noexcept = 0;

    /// Buttons that are down, a bit each.
    virtual std::uint32_t buttons() const noexcept = 0;
};

/// The hand for the task's goal. @pre params.validate() is empty.
std::unique_ptr<TaskHand> makeHand(const HandParams& params, const VisibleTask& task,
                                   const HandRegistration& registration, std::uint64_t seed);

}  // namespace passung::simulated
