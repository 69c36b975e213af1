#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/device_description.h"
#include "study/session/apparatus.h"

namespace passung::store {

/// `text` as a JSON string, quotes included; control characters escaped.
std::string jsonString(std::string_view text);

/// The shortest decimal that reads back to the same double; `null` if it is not finite.
std::string jsonNumber(double value);

/// The device as a session stores it: every field of the description, units in the keys.
std::string deviceJson(const DeviceDescription& device);

/// `[{"stage":…,"reason":…}, …]`
std::string stagesJson(std::span<const session::StageNote> stages);

}  // namespace passung::store
