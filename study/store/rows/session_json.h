#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "study/session/apparatus.h"

namespace passung::store {

/// The device as a session stores it: every field of the description, units in the keys.
std::string deviceJson(const DeviceDescription& device);

/// `[{"stage":…,"reason":…}, …]`
std::string stagesJson(std::span<const session::StageNote> stages);

}  // namespace passung::store
