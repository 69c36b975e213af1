#pragma once

#include <cstddef>

#include "core/model/mesh.h"

namespace passung::model {

/// How many triangles an edge of another triangle passes through, or pass an edge through another: the surface meets
/// itself there, or one piece another. Triangles that touch, share an edge or lie upon each other do not count, nor
/// more than 256 around one. The same on every machine; its time grows as n log n for a surface whose triangles do not
/// pile up.
std::size_t crossingTriangles(const TriangleMesh& mesh);

}  // namespace passung::model
