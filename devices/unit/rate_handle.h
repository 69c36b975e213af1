#pragma once

#include "core/base/tick_record.h"
#include "core/base/types.h"

namespace passung::unit {

/// A handle for a unit that only says how fast it is to move: it goes at that speed and gives way to the wrench that a
/// scene asks for,
///     v = v_said + b F,  w = w_said + c T,
/// so that pressed on a wall of stiffness K it comes to rest v_said / (b K) behind its surface, where the force is
/// v_said / b. It stays within `radius` of the origin. A step is stable while b K T < 1: for K = 20 kN/m it is 0.4.
struct RateHandle {
    static constexpr double kGiving = 0.02;       // b [m/s/N]: 5 N at 0.1 m/s
    static constexpr double kTurningGiving = 10;  // c [rad/s/N·m]: 0.1 N·m at 1 rad/s

    Pose X_BD;

    /// Lets one tick pass. rt-safe.
    void advance(const Twist& said, const Wrench& F_D_B, double radius) noexcept {
        const Vec3 v = said.v + kGiving * F_D_B.force;
        const Vec3 w = said.w + kTurningGiving * F_D_B.torque;
        X_BD.p += kTickSeconds * v;
        if (const double away = X_BD.p.norm(); away > radius) X_BD.p *= radius / away;
        X_BD.q = (rotationFromVector(kTickSeconds * w) * X_BD.q).normalized();
    }
};

}  // namespace passung::unit
