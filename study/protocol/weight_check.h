#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/scene/scene_spec.h"
#include "study/protocol/document.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// Adds an error for each density of a part that encloses no volume, for weight without a density of the held part, and
/// for a weight that the device or the coupling cannot carry; where what hangs from the hand is seen to hang, or its
/// torque is not shown as it is, a sentence to `warnings`. `table`: of the scene, of path `path`.
void checkWeight(const Node& table, const std::string& path, const scene::SceneSpec& scene, PartGeometries& geometries,
                 Errors& errors, std::vector<std::string>& warnings);

}  // namespace passung::protocol
