#pragma once

#include <cstdint>

#include "core/loop/haptic_device.h"
#include "devices/simulated/device_dynamics.h"
#include "devices/simulated/task_hand.h"

namespace passung::simulated {

/// A haptic device held by a simulated person. Time passes in read(): one tick per call. The handle starts a few
/// millimetres away from the start pose that the display shows.
class SimulatedDevice final : public loop::HapticDevice {
public:
    /// @pre the validate() of both parameter sets is empty. Everything random comes from `seed`.
    SimulatedDevice(const DeviceParams& device, const HandParams& hand, const VisibleTask& task,
                    const HandRegistration& registration, std::uint64_t seed);

    const DeviceDescription& description() const override { return description_; }
    DeviceReading read() noexcept override;
    void command(const Wrench& F_D_B) noexcept override { dynamics_.command(F_D_B); }
    void show(const loop::DisplayedImage& image) noexcept override { hand_->see(image); }

    /// Cues that the person is given beside the force, after each tick. rt-safe.
    void notice(const GivenCues& cues) noexcept { hand_->notice(cues); }

    const TaskHand& hand() const noexcept { return *hand_; }
    const DeviceDynamics& dynamics() const noexcept { return dynamics_; }

private:
    DeviceDescription description_;
    DeviceDynamics dynamics_;
    std::unique_ptr<TaskHand> hand_;
};

}  // namespace passung::simulated
