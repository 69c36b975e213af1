#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/device_description.h"
#include "core/base/result.h"
#include "core/scene/build_store.h"
#include "core/scene/scene_spec.h"

namespace passung::protocol {

/// Reads a scene file. Mesh paths in it are relative to it. Its `device.preset` is looked up among `devices`; the
/// device's limits and stable stiffness fill what the file leaves open. All problems are collected, each with its
/// place. `builds` reads meshes if it is a scene::MeshSource; else this process does.
Result<scene::SceneSpec> readScene(const std::string& path, std::span<const DeviceDescription> devices,
                                   scene::BuildStore* builds = nullptr);

/// The same for a text that stands for the file `path` (names in messages and the base of mesh paths).
Result<scene::SceneSpec> readSceneText(const std::string& text, const std::string& path,
                                       std::span<const DeviceDescription> devices, scene::BuildStore* builds = nullptr);

/// A scene and the preset that it names, empty if none; `warnings`: what is allowed but should be known, in sentences.
struct SceneOnDevice {
    scene::SceneSpec scene;
    std::string device;
    std::vector<std::string> warnings;
};
Result<SceneOnDevice> readSceneOnDevice(const std::string& text, const std::string& path,
                                        std::span<const DeviceDescription> devices,
                                        scene::BuildStore* builds = nullptr);

/// Reads a file with one [[part]], held or not. `metres_per_unit` applies where the file has no `unit`.
Result<scene::PartSpec> readPart(const std::string& path, double metres_per_unit = 1e-3);

}  // namespace passung::protocol
