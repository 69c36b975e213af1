#pragma once

#include "core/base/result.h"
#include "core/scene/scene_spec.h"
#include "study/protocol/document.h"
#include "study/protocol/part_surface.h"

namespace passung::protocol {

/// How deep a part at `X_WP` stands in `obstacle`, or that in it [m]; 0 if neither does, or a mesh cannot be read. A
/// lower bound, found at points of both surfaces a twenty-fourth of a part's size apart, of large meshes at corners.
double depthAt(const scene::PartSpec& part, const Pose& X_WP, const scene::PartSpec& obstacle,
               PartGeometries& geometries);

/// The same of the held part at its start.
double startDepth(const scene::PartSpec& held, const scene::PartSpec& obstacle);

/// Adds an error at the held part's pose in the table `scene`, of path `path`, for every obstacle in which it starts
/// deeper than the field's tolerance: the hand would begin within a wall, and be pushed out of it.
void checkStartPose(const Node& scene, const std::string& path, const scene::SceneSpec& spec,
                    PartGeometries& geometries, Errors& errors);

}  // namespace passung::protocol
