#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/field/surface_block.h"
#include "core/geometry/triangle_tree.h"

namespace passung::field {

struct FlatTriangle;

/// Samples a mesh block by block: triangles that cannot be nearest in a part of the block are left out there, so that
/// few are tried at each point, and all points of the part at once. Const; thread-safe.
class MeshBlockSampler {
public:
    /// `closed`: the triangles bound solids; the sign comes from counting crossings along the grid lines, from one
    /// winding number in each block. `uncrossed`: no triangle passes through another, as MeshReport::crossing_triangles
    /// tells; if all of them part outside (in front) from inside as well, each cell gets a slack, else it is 1.
    MeshBlockSampler(std::shared_ptr<const geometry::TriangleTree> tree, bool closed, bool uncrossed);

    /// Exact but for rounding. `low`: the block's first corner; `cell`: the edge of a cell [m].
    void sample(const Vec3& low, double cell, SurfaceBlock& block) const;

    /// Exact, from those triangles of a block.
    double distance(const Vec3& p, std::span<const std::uint32_t> triangles) const;

private:
    // Shared by the functions of a DistanceSource and their copies.
    std::shared_ptr<const geometry::TriangleTree> tree_;
    std::shared_ptr<const std::vector<FlatTriangle>> flats_;  // in tree order
    bool closed_, simple_;
};

}  // namespace passung::field
