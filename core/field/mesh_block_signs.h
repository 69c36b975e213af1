#pragma once

#include <vector>

#include "core/base/types.h"
#include "core/field/mesh_block_kernels.h"
#include "core/field/surface_block.h"
#include "core/geometry/triangle_tree.h"

namespace passung::field {

/// Lines are counted along this far beside the nodes at most, in cells.
inline constexpr double kLineShift = 1e-6;

/// Makes the nodes of a block inside of closed geometry negative: by counting crossings along the grid lines, from one
/// winding number. `triangles`: at least those that meet the block, kLineShift around it included. Where the counts
/// contradict the distances each node is asked on its own, and no slack is claimed.
void giveSigns(const geometry::TriangleTree& tree, const std::vector<const FlatTriangle*>& triangles, const Vec3& low,
               double cell, SurfaceBlock& block);

}  // namespace passung::field
