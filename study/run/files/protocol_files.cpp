#include "study/run/files/protocol_files.h"

#include "study/run/files/builds.h"
#include "study/run/files/known_names.h"

namespace passung::run {

Result<plan::StudyPlan> readProtocol(const std::string& path, const ImportLimits& limits) {
    Builds builds(nullptr, limits);
    return protocol::readProtocol(path, knownDevices(), knownMeasures(), &builds);
}

protocol::Examined examineProtocol(const std::string& path, const ImportLimits& limits) {
    Builds builds(nullptr, limits);
    return protocol::examineProtocol(path, knownDevices(), knownMeasures(), &builds);
}

Result<plan::StudyPlan> readBegunProtocol(const std::string& text, const std::string& path,
                                          std::span<const DeviceDescription> devices, const ImportLimits& limits,
                                          scene::Geometry automatic) {
    Builds builds(nullptr, limits);
    return protocol::readBegunProtocol(text, path, devices, knownMeasures(), &builds, automatic);
}

Result<protocol::SceneOnDevice> readSceneOnDevice(const std::string& text, const std::string& path,
                                                  const ImportLimits& limits) {
    Builds builds(nullptr, limits);
    return protocol::readSceneOnDevice(text, path, knownDevices(), &builds);
}

}  // namespace passung::run
