#pragma once

#include <algorithm>

#include "core/base/device_description.h"
#include "core/base/types.h"

namespace passung::unit {

/// What of a wrench may reach a unit: finite, force and torque scaled by one factor into the unit's own limits, no
/// torque where it has none, and zero unless it is ready. The output stage has limited it by what the scene allows
/// already; this stands below it, whoever commands. rt-safe.
inline Wrench passed(const Wrench& F_D_B, const DeviceDescription& limits, bool ready) noexcept {
    if (!ready || !isFinite(F_D_B)) return {};
    Wrench within = F_D_B;
    if (limits.actuated_degrees < 6) within.torque.setZero();
    // Of numbers near the largest one the norm would be infinite.
    const double largest = std::max(within.force.cwiseAbs().maxCoeff(), within.torque.cwiseAbs().maxCoeff());
    if (largest > 1e100) return {};
    double share = 1.0;
    if (const double force = within.force.norm(); force > limits.max_force_N) share = limits.max_force_N / force;
    if (const double torque = within.torque.norm(); torque > limits.max_torque_Nm)
        share = std::min(share, limits.max_torque_Nm / torque);
    // A rounding above the limit is above it.
    if (share < 1.0) share *= 1.0 - 1e-12;
    within.force *= share;
    within.torque *= share;
    return within;
}

}  // namespace passung::unit
