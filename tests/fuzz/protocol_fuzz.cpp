#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "devices/simulated/presets.h"
#include "study/measures/measures.h"
#include "study/protocol/protocol_reader.h"

namespace {

/// Devices that a study may name, as their makers rate them.
std::vector<passung::DeviceDescription> ratedDevices() {
    std::vector<passung::DeviceDescription> all;
    for (const auto& preset : passung::simulated::presets()) all.push_back(passung::simulated::describe(preset));
    return all;
}

std::vector<std::string> measureNames() {
    std::vector<std::string> names;
    for (const auto& definition : passung::measures::definitions()) names.push_back(definition.name);
    return names;
}

}  // namespace

/// libFuzzer: any text is a study that can be run, or errors that say what is wrong. The text stands for a file beside
/// the shipped peg in hole, so that names of other files lead somewhere.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace passung;
    const std::string text(reinterpret_cast<const char*>(data), size);
    static const auto known_devices = ratedDevices();
    static const auto known_measures = measureNames();
    const auto plan = protocol::readProtocolText(text, PASSUNG_SOURCE_DIR "/protocols/peg_in_hole/fuzzed.toml",
                                                 known_devices, known_measures);
    if (plan) {
        if (plan->conditions.empty()) std::abort();
        return 0;
    }
    if (plan.errors().empty()) std::abort();
    for (const Error& error : plan.errors())
        if (error.message.empty() || error.message.find('\n') != std::string::npos) std::abort();
    return 0;
}
