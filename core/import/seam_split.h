#pragma once

#include <cstddef>

#include "core/geometry/mesh.h"

namespace passung::importer {

/// Splits edges of one triangle only at the vertices of other such edges that lie on them (T-junctions): at most
/// `reach` beside the edge, and farther than that from its ends [m]. The triangle is cut into pieces with the vertex as
/// a corner, so that it shares the parts of its edge with the neighbours there; no vertex moves, and the surface moves
/// by no more than `reach`. Returns how many times an edge was split. @pre vertices nearer than `reach` are one.
std::size_t splitSeams(geometry::TriangleMesh& mesh, double reach);

}  // namespace passung::importer
