#include "study/run/units/station_devices.h"

#include <algorithm>
#include <filesystem>

#include "study/protocol/station/station_file.h"
#include "study/run/files/data_folder.h"

namespace passung::run {
namespace {

/// The user's; empty: there is none.
std::string usualFile() {
    const auto folder = dataFolder();
    std::error_code none;
    if (folder.empty() || !std::filesystem::exists(folder / "station.toml", none)) return {};
    return (folder / "station.toml").string();
}

}  // namespace

bool StationDevices::anyReal() const {
    return std::any_of(devices.begin(), devices.end(),
                       [](const DeviceChoice& choice) { return choice.backend != kSimulatedBackend; });
}

Result<StationDevices> stationDevices(const std::string& named) {
    StationDevices station{{}, named.empty() ? usualFile() : named};
    if (station.file.empty()) return station;
    auto devices = protocol::readStationFile(station.file);
    if (!devices) return devices.errors();
    station.devices = *std::move(devices);
    return station;
}

}  // namespace passung::run
