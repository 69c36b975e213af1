#pragma once

#include <memory>
#include <vector>

#include "core/base/types.h"
#include "core/model/surface_block.h"
#include "core/model/triangle_tree.h"

namespace passung::model {

/// Samples a mesh block by block: triangles that cannot be nearest in a part of the block are left out there, so that
/// few are tried at each point, and all points of the part at once. Const; thread-safe.
class MeshBlockSampler {
public:
    /// `closed`: the triangles bound solids; the sign comes from counting crossings along the grid lines, from one
    /// winding number in each block.
    MeshBlockSampler(std::shared_ptr<const TriangleTree> tree, bool closed);

    /// Exact but for rounding. `low`: the block's first corner; `cell`: the edge of a cell [m].
    void sample(const Vec3& low, double cell, SurfaceBlock& block) const;

    struct Flat;  // a triangle prepared for distances

private:
    // Shared by the functions of a DistanceSource and their copies.
    std::shared_ptr<const TriangleTree> tree_;
    std::shared_ptr<const std::vector<Flat>> flats_;  // in tree order
    bool closed_;
};

}  // namespace passung::model
