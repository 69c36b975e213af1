#pragma once

#include <string>
#include <vector>

#include "core/base/device_description.h"

namespace passung::run {

/// Every device that a protocol may name, as its maker or its model describes it.
const std::vector<DeviceDescription>& presetDevices();

/// The same with the stable stiffness that was found on this machine, where it was. Throws std::runtime_error if a
/// calibration file is not sound.
const std::vector<DeviceDescription>& knownDevices();

/// Names of all measures.
const std::vector<std::string>& knownMeasures();

}  // namespace passung::run
