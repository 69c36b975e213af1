#pragma once

#include <string_view>

#include "core/scene/scene_spec.h"

namespace passung::plan {

/// The part in the first hand; nullptr if there is none (a scene that was validated has one).
const scene::PartSpec* heldPart(const scene::SceneSpec& scene);

/// Where hand `hand` starts: what it holds, or of an empty hand what its registration puts into the handle.
Pose startPose(const scene::SceneSpec& scene, std::size_t hand);

/// The part of this name; nullptr if there is none.
const scene::PartSpec* partNamed(const scene::SceneSpec& scene, std::string_view name);

}  // namespace passung::plan
