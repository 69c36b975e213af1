#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "study/protocol/protocol_reader.h"
#include "study/protocol/scene_reader.h"
#include "study/run/files/mesh_importer.h"

namespace passung::run {

/// What protocol::readProtocol() and its neighbours give, with this program's devices and measures. Meshes are read by
/// the program passung-import, as for the parts themselves: see Builds.
Result<plan::StudyPlan> readProtocol(const std::string& path, const ImportLimits& limits = {});
protocol::Examined examineProtocol(const std::string& path, const ImportLimits& limits = {});
Result<plan::StudyPlan> readBegunProtocol(const std::string& text, const std::string& path,
                                          std::span<const DeviceDescription> devices, const ImportLimits& limits = {},
                                          scene::Geometry automatic = scene::Geometry::Auto);
Result<protocol::SceneOnDevice> readSceneOnDevice(const std::string& text, const std::string& path,
                                                  const ImportLimits& limits = {});

}  // namespace passung::run
