#pragma once

#include <vector>

#include "core/base/device_description.h"

namespace passung::protocol {

/// Two devices with round numbers: "arm" drives all six degrees, "stick" only forces.
inline std::vector<DeviceDescription> fakeDevices() {
    DeviceDescription arm;
    arm.name = "arm";
    arm.max_force_N = 20.0;
    arm.max_torque_Nm = 0.5;
    arm.max_force_rate_N_per_s = 5000.0;
    arm.delay_ticks = 3;
    arm.stable_stiffness_N_per_m = 4000.0;
    arm.stable_rotational_stiffness_Nm_per_rad = 8.0;
    arm.recommended_damping_Ns_per_m = 5.0;
    arm.recommended_rotational_damping_Nms_per_rad = 0.002;
    DeviceDescription stick = arm;
    stick.name = "stick";
    stick.actuated_degrees = 3;
    stick.max_torque_Nm = 0.0;
    stick.stable_stiffness_N_per_m = 1000.0;
    stick.stable_rotational_stiffness_Nm_per_rad = 0.0;
    return {arm, stick};
}

}  // namespace passung::protocol
