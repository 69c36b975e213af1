#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/device_unit.h"
#include "core/base/result.h"
#include "devices/unit/unit.h"

namespace passung::backends {

/// What a look for a backend's units found.
struct Sighting {
    std::vector<DeviceUnit> units;
    std::string why_not;  // in words that a lab engineer can act on; empty: there are units
};

/// A way to real devices. All that there are stand in all(): nothing else lists them.
struct Backend {
    std::string_view name;   // in a station file
    std::string_view label;  // for people
    std::string_view kind;   // that its units are
    Sighting (*look)(const std::string& address);
    Result<std::unique_ptr<unit::Unit>> (*open)(const DeviceChoice& choice, const DeviceDescription& description);
};

std::span<const Backend> all();
const Backend* find(std::string_view name);  // null: none

/// Opens the unit of the choice; it connects by itself, and again. Errors: the choice cannot be that of any unit.
Result<std::unique_ptr<unit::Unit>> open(const DeviceChoice& choice);

/// Why such a unit cannot stand for that kind, one sentence each; none: it can.
std::vector<std::string> whyWeaker(const DeviceDescription& unit, const DeviceDescription& kind);

}  // namespace passung::backends
