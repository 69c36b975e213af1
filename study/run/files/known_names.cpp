#include "study/run/files/known_names.h"

#include <stdexcept>

#include "devices/simulated/presets.h"
#include "study/measures/measures.h"
#include "study/run/machine/calibration.h"

namespace passung::run {

const std::vector<DeviceDescription>& presetDevices() {
    static const std::vector<DeviceDescription> devices = [] {
        std::vector<DeviceDescription> all;
        for (const auto* list : {&simulated::presets(), &simulated::standIns()})
            for (const auto& preset : *list) all.push_back(simulated::describe(preset));
        return all;
    }();
    return devices;
}

const std::vector<DeviceDescription>& knownDevices() {
    static const std::vector<DeviceDescription> devices = [] {
        const auto calibrated = withCalibrations(presetDevices());
        if (calibrated) return *calibrated;
        std::string lines;
        for (const Error& error : calibrated.errors()) lines += (lines.empty() ? "" : "\n") + toString(error);
        throw std::runtime_error(lines);
    }();
    return devices;
}

const std::vector<std::string>& knownMeasures() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& definition : measures::definitions()) all.push_back(definition.name);
        return all;
    }();
    return names;
}

}  // namespace passung::run
