#pragma once

#include <string>
#include <vector>

#include "devices/simulated/presets.h"
#include "study/measures/measures.h"

namespace passung::protocol {

// What the program knows: all presets and measures.

inline std::vector<DeviceDescription> knownDevices() {
    std::vector<DeviceDescription> devices;
    for (const auto* list : {&simulated::presets(), &simulated::standIns()})
        for (const auto& preset : *list) devices.push_back(simulated::describe(preset));
    return devices;
}

inline std::vector<std::string> knownMeasures() {
    std::vector<std::string> names;
    for (const auto& definition : measures::definitions()) names.push_back(definition.name);
    return names;
}

}  // namespace passung::protocol
