#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "study/protocol/protocol_reader.h"
#include "study/run/files/known_names.h"

/// libFuzzer: any text is a study that can be run, or errors that say what is wrong. The text stands for a file beside
/// the shipped peg in hole, so that names of other files lead somewhere.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace passung;
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto plan = protocol::readProtocolText(text, PASSUNG_SOURCE_DIR "/protocols/peg_in_hole/fuzzed.toml",
                                                 run::knownDevices(), run::knownMeasures());
    if (plan) {
        if (plan->conditions.empty()) std::abort();
        return 0;
    }
    if (plan.errors().empty()) std::abort();
    for (const Error& error : plan.errors())
        if (error.message.empty() || error.message.find('\n') != std::string::npos) std::abort();
    return 0;
}
