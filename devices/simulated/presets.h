#pragma once

#include <string_view>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/result.h"

namespace passung::simulated {

/// A number and where it comes from, in words; the texts are constants of presets.cpp.
struct Sourced {
    double value = 0.0;
    std::string_view source;
};

/// One haptic device as the simulator and the stability rule see it. SI units. 0 in a limit = not known or not present.
struct DeviceParams {
    std::string_view name;     // key in protocols: "sigma7"
    std::string_view label;    // for people
    int sensed_degrees = 6;    // 3: the handle does not turn
    int actuated_degrees = 6;  // 3: force only
    int delay_ticks = 0;       // whole ticks between command and effect, 0 … loop::kMaxDeviceDelayTicks
    std::string_view degrees_source;
    Sourced mass;                            // felt at the handle [kg], > 0
    Sourced inertia;                         // felt about the handle's origin [kg·m²], > 0
    Sourced damping;                         // [N·s/m]
    Sourced rotational_damping;              // [N·m·s/rad]
    Sourced coulomb_force;                   // [N]
    Sourced coulomb_torque;                  // [N·m]
    Sourced quantum;                         // encoder step of each coordinate [m]
    Sourced rotational_quantum;              // of each component of the rotation vector from home [rad]
    Sourced max_force;                       // what the output is limited to [N], > 0; a peak where the source says so
    Sourced max_torque;                      // [N·m]; 0 where torque is not actuated
    Sourced continuous_force;                // that the motors hold for long [N]; 0 = not known; information only
    Sourced peak_force;                      // for moments [N]; information only
    Sourced peak_torque;                     // [N·m]
    Sourced max_force_rate;                  // of rising force [N/s], > 0
    Sourced workspace_radius;                // of a ball about the base's origin, where the end stops are [m]
    Sourced vendor_stiffness;                // largest the driver or maker recommends [N/m]
    Sourced vendor_rotational_stiffness;     // [N·m/rad]
    Sourced recommended_damping;             // of the wall, at which the stable stiffness is stated [N·s/m]
    Sourced recommended_rotational_damping;  // [N·m·s/rad]
    Sourced buttons = {};                    // of the handle; 0 = not known

    /// Everything out of range; key = field.
    std::vector<Error> validate() const;
};

/// Share of the exact stability border that a study may use.
inline constexpr double kStableShare = 0.7;

/// What the device says about itself. Stable stiffness = kStableShare × exact border at the recommended damping, or the
/// maker's limit if that is smaller.
DeviceDescription describe(const DeviceParams& params);

/// sigma7, hug, virtuose6d, falcon, whi, touch.
const std::vector<DeviceParams>& presets();

/// Simulated in place of kinds of device whose mechanism nobody has told: inverse3, spacemouse, tracker, and kAnyKind,
/// of which no stable stiffness is known.
const std::vector<DeviceParams>& standIns();

/// Of either; nullptr if there is none of that name.
const DeviceParams* findPreset(std::string_view name);

}  // namespace passung::simulated
