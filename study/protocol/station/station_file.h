#pragma once

#include <string>
#include <vector>

#include "core/base/device_unit.h"
#include "core/base/result.h"

namespace passung::protocol {

/// What a station file says of each hand, in the order of the file. Errors: all of them, with their places.
Result<std::vector<DeviceChoice>> readStationFile(const std::string& path);

/// A file that says so.
std::string stationFileText(const std::vector<DeviceChoice>& devices);

}  // namespace passung::protocol
