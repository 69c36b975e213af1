#pragma once

#include <string_view>

#include "core/scene/scene_spec.h"

namespace passung::protocol {

/// The part in the hand; nullptr if there is none (a scene that was validated has one).
const model::PartSpec* heldPart(const model::SceneSpec& scene);

/// The part of this name; nullptr if there is none.
const model::PartSpec* partNamed(const model::SceneSpec& scene, std::string_view name);

}  // namespace passung::protocol
