#pragma once

#include <array>

#include "core/base/types.h"
#include "core/loop/stability.h"
#include "devices/simulated/presets.h"

namespace passung::simulated {

/// The hand as the device feels it during one tick: a mass that rides on the handle and a spring-damper to a set-point.
struct HandCoupling {
    bool attached = false;                                        // false: nobody holds the handle, the rest is ignored
    double mass = 0.0;                                            // [kg], ≥ 0
    double inertia = 0.0;                                         // [kg·m²], ≥ 0
    double stiffness = 0.0, damping = 0.0;                        // [N/m], [N·s/m]
    double rotational_stiffness = 0.0, rotational_damping = 0.0;  // [N·m/rad], [N·m·s/rad]
    Pose X_BSet;                                                  // set-point of the handle
    Wrench F_D_B;  // additional force of the muscles (tremor), about the handle's origin
};

/// The mechanism of a haptic device: a rigid handle with mass and isotropic inertia, viscous and Coulomb friction,
/// force limits, command delay and encoders. No gravity (compensated). Deterministic; all but the constructor rt-safe.
class DeviceDynamics {
public:
    /// @pre params.validate() is empty. `X_BDHome` is where the encoders read zero, and where the handle rests.
    DeviceDynamics(const DeviceParams& params, const Pose& X_BDHome);

    /// Commands `F_D_B`, on the hand, about the handle's origin. It acts from the next advance() on, delay_ticks later.
    /// Limited to what the motors give; a wrench that is not finite counts as zero.
    void command(const Wrench& F_D_B) noexcept;

    /// Moves on by one tick of kTickSeconds.
    void advance(const HandCoupling& hand) noexcept;

    /// What the encoders say.
    Pose readPose() const noexcept;

    /// Where the handle really is and how it moves, base frame.
    const Pose& truePose() const noexcept { return X_BD_; }
    const Twist& trueTwist() const noexcept { return V_BD_B_; }
    void place(const Pose& X_BD, const Twist& V_BD_B) noexcept { X_BD_ = X_BD, V_BD_B_ = V_BD_B; }

    /// The wrench that the motors gave during the last tick: after limits and delay.
    const Wrench& actingWrench() const noexcept { return acting_; }

    /// What the hand has put into the handle in all: the energy account at the hand's port [J]. Less than zero:
    /// mechanism and controller have given out more than they took in. (A speed from place() counts as the hand's to
    /// take.)
    double handEnergy() const noexcept { return hand_energy_; }

private:
    Wrench limited(const Wrench& wrench) const noexcept;

    DeviceParams params_;
    Pose X_BDHome_;
    Pose X_BD_;
    Twist V_BD_B_;
    Wrench acting_;
    double hand_energy_ = 0.0;
    std::array<Wrench, loop::kMaxDeviceDelayTicks + 1> pending_{};  // ring: the command of tick k at k modulo its size
    std::size_t next_ = 0;
};

}  // namespace passung::simulated
