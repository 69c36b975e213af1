#pragma once

#include <string>
#include <vector>

#include "core/base/device_unit.h"

namespace passung::run {

/// What of real devices is here: a line for each backend, its units or why there are none and what to do.
struct UnitReport {
    std::string text;
    std::vector<DeviceChoice> found;  // as a station file would choose them: those that push first, one hand each
};

/// Looks for all of them where `station` says that they are, else where they usually are.
UnitReport lookForUnits(const std::vector<DeviceChoice>& station);

}  // namespace passung::run
