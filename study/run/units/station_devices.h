#pragma once

#include <string>
#include <vector>

#include "core/base/device_unit.h"
#include "core/base/result.h"

namespace passung::run {

/// What a station file chooses.
struct StationDevices {
    std::vector<DeviceChoice> devices;
    std::string file;  // empty: there is none

    bool anyReal() const;
};

/// Of the file that is named, else of `station.toml` in the folder of the user's data; no devices where there is none.
Result<StationDevices> stationDevices(const std::string& named);

}  // namespace passung::run
