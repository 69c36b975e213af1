#pragma once

#include <string>

#include "core/base/device_description.h"
#include "core/base/result.h"

namespace passung::protocol {

/// What was found on a device of this machine: how stiff a wall it bears. 0: not known or not actuated.
struct Calibration {
    std::string device;                 // preset or model
    double stable_stiffness = 0.0;      // that a study may use [N/m]
    double rotational_stiffness = 0.0;  // likewise [N·m/rad]
    double calm_stiffness = 0.0;        // largest at which the device came to rest [N/m]
    double calm_rotational_stiffness = 0.0;
    double damping = 0.0;             // of the wall, with which they were found [N·s/m]
    double rotational_damping = 0.0;  // [N·m·s/rad]
};

/// Reads a calibration file. Errors: all that is wrong with it, each with its place.
Result<Calibration> readCalibration(const std::string& path);

/// The text of such a file: what readCalibration reads as the same numbers.
std::string calibrationText(const Calibration& calibration);

/// The device with the stable stiffness that was found; `stability_source` says so. Errors: it is another device's, or
/// was found with another damping than the device recommends now.
Result<DeviceDescription> calibrated(DeviceDescription device, const Calibration& calibration, const std::string& path);

}  // namespace passung::protocol
