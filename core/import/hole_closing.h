#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"
#include "core/geometry/triangle_tree.h"

namespace passung::importer {

/// From one vertex to another.
using DirectedEdge = std::array<std::uint32_t, 2>;

/// Whether a surface that is not closed has an inside: the mean over its area of the winding numbers just behind and
/// just in front of it, added. 1: a solid (1 behind, 0 in front); -1: a solid inside out (0 and -1); 0: a sheet (½ and
/// -½).
/// @pre `tree` is of `mesh`, which has triangles.
double insideBalance(const geometry::TriangleMesh& mesh, const geometry::TriangleTree& tree);

struct HoleClosing {
    std::size_t holes = 0;       // closed
    std::size_t seams = 0;       // closed loops without area: a vertex lies on a neighbour's edge
    std::size_t triangles = 0;   // added for that
    std::size_t edges_left = 0;  // open edges of loops that were left
};

/// Closes the holes of a solid: its open edges are split into loops that pass no vertex twice, and each loop is closed
/// by a triangle or by a fan about its centroid.
///   A loop is left if its fan does not lie where the winding number is about ½, between inside and outside: then it is
///   no hole but a crack, for instance between two patches that share no vertices, and a fan would be a wall inside the
///   part or cover a triangle by its reverse.
///   With `edges_left` = 0 every edge is used as often in one direction as in the other, the winding number is whole
///   everywhere, and it changes at triangles only.
/// `open_edges` run as a triangle of the filling would. `tree` is of the mesh as it was; `facing` = -1 if all triangles
/// have been turned since, else 1.
HoleClosing closeHoles(geometry::TriangleMesh& mesh, const std::vector<DirectedEdge>& open_edges,
                       const geometry::TriangleTree& tree, double facing);

}  // namespace passung::importer
