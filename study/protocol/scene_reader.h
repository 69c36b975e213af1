#pragma once

#include <span>
#include <string>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "core/model/scene_spec.h"

namespace passung::protocol {

/// Reads a scene file. Mesh paths in it are relative to it. Its `device.preset` is looked up among `devices`; the
/// device's limits and stable stiffness fill what the file leaves open. All problems are collected, each with its
/// place.
Result<model::SceneSpec> readScene(const std::string& path, std::span<const DeviceDescription> devices);

/// The same for a text that stands for the file `path` (names in messages and the base of mesh paths).
Result<model::SceneSpec> readSceneText(const std::string& text, const std::string& path,
                                       std::span<const DeviceDescription> devices);

/// A scene and the preset that it names, empty if none.
struct SceneOnDevice {
    model::SceneSpec scene;
    std::string device;
};
Result<SceneOnDevice> readSceneOnDevice(const std::string& text, const std::string& path,
                                        std::span<const DeviceDescription> devices);

/// Reads a file with one [[part]], held or not. `metres_per_unit` applies where the file has no `unit`.
Result<model::PartSpec> readPart(const std::string& path, double metres_per_unit = 1e-3);

}  // namespace passung::protocol
