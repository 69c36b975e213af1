#pragma once

#include "core/base/result.h"
#include "core/model/scene_spec.h"
#include "study/protocol/document.h"

namespace passung::protocol {

/// How deep the held part stands in `obstacle` at its start pose [m]; 0 if it does not, or if one of the two is no
/// parametric shape. A lower bound, found at points of both surfaces a twenty-fourth of a part's size apart.
double startDepth(const model::PartSpec& held, const model::PartSpec& obstacle);

/// Adds an error at the held part's pose in the table `scene`, of path `path`, for every obstacle in which it starts
/// deeper than the field's tolerance: the hand would begin within a wall, and be pushed out of it.
void checkStartPose(const Node& scene, const std::string& path, const model::SceneSpec& spec, Errors& errors);

}  // namespace passung::protocol
