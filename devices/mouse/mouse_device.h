#pragma once

#include "core/base/device_description.h"
#include "core/loop/haptic_device.h"
#include "devices/mouse/pointer.h"
#include "devices/simulated/device_dynamics.h"
#include "devices/simulated/hand_params.h"

namespace passung::mouse {

/// A haptic device of a preset as it would move if a hand pulled its handle after the pointer: six degrees for whoever
/// has a mouse only. The hand is a spring and a critically damping damper between pointer and handle,
///     F = k (x_pointer - x) - d v,   k = ω² M,  d = 2 ω M,   M: handle and hand, ω = kFollowing,
/// and pulls with at most kPull of what the motors can give: so no wall gives way to a mouse, and at rest the wrench
/// that is felt is the spring's, which a window shows by how far the part stays behind and by an arrow. Rotation alike.
class MouseDevice final : public loop::HapticDevice {
public:
    static constexpr double kFollowing = 40.0;      // ω [rad/s]: a free handle is behind by 2/ω = 50 ms
    static constexpr double kPull = 0.8;            // of the motors' limit
    static constexpr double kHandMass = 0.1;        // [kg]
    static constexpr double kHandInertia = 1.0e-4;  // [kg·m²]

    /// Begins at rest with the held part at `X_WHeldStart`, and so does the pointer, which outlives the device.
    MouseDevice(const simulated::DeviceParams& preset, const simulated::HandRegistration& registration,
                const Pose& X_WHeldStart, Pointer& pointer);

    const DeviceDescription& description() const override { return description_; }
    DeviceReading read() noexcept override;
    void command(const Wrench& F_D_B) noexcept override { dynamics_.command(F_D_B); }

    bool pushesHand() const override { return false; }

    /// How far the pointer may be ahead of the handle for all of the pull [m], [rad]; farther changes nothing.
    double reach() const noexcept { return reach_; }
    double swing() const noexcept { return swing_; }

private:
    DeviceDescription description_;
    simulated::HandRegistration registration_;
    Pointer& pointer_;
    simulated::DeviceDynamics dynamics_;
    simulated::HandCoupling hand_;
    double reach_, swing_;
};

/// What a MouseDevice of the preset says about itself.
DeviceDescription mouseDescription(const simulated::DeviceParams& preset);

}  // namespace passung::mouse
