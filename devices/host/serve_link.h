#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/device_unit.h"
#include "core/base/result.h"
#include "devices/unit/link.h"

namespace passung::host {

/// What a device host does with a closed library: the same link that a backend without one has in the study's process.
struct HostedLibrary {
    /// The units that it sees; `library` is the file to load, empty: the usual ones.
    Result<std::vector<DeviceUnit>> (*look)(const std::string& library);
    std::unique_ptr<unit::Link> (*link)(const DeviceChoice& choice, const DeviceDescription& limits);
};

/// The whole of a device host's work, until the study has gone; the exit code. A cycle of the device begins with each
/// command, or kPatience after the last one, or where the library has a servo thread with each of its ticks; the
/// device's last wrench is zero.
int serveLibrary(const HostedLibrary& library);

inline constexpr std::chrono::milliseconds kPatience{2};

}  // namespace passung::host
