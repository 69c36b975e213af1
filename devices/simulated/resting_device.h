#pragma once

#include "core/base/types.h"
#include "core/loop/haptic_device.h"
#include "devices/simulated/presets.h"

namespace passung::simulated {

/// A haptic device that nobody holds: its handle stays where it is, whatever is commanded. For trials in which no part
/// is moved with it. rt-safe.
class RestingDevice final : public loop::HapticDevice {
public:
    RestingDevice(const DeviceParams& device, const Pose& X_BD) : description_(describe(device)), X_BD_(X_BD) {}

    const DeviceDescription& description() const override { return description_; }
    DeviceReading read() noexcept override { return {.X_BD = X_BD_, .hand_energy_J = 0.0}; }
    void command(const Wrench&) noexcept override {}

private:
    DeviceDescription description_;
    Pose X_BD_;
};

}  // namespace passung::simulated
