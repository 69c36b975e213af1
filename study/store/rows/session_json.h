#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "core/base/device_unit.h"
#include "study/session/apparatus.h"

namespace passung::store {

/// The device as a session stores it: every field of the description, units in the keys; then, if there are any, the
/// real devices that serve its hands.
std::string deviceJson(const DeviceDescription& device, std::span<const DeviceUnit> units = {});

/// `[{"stage":…,"reason":…}, …]`
std::string stagesJson(std::span<const session::StageNote> stages);

}  // namespace passung::store
