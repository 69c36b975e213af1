#pragma once

#include <cstddef>

#include "core/geometry/mesh.h"

namespace passung::importer {

/// Where a surface meets itself, or one piece another.
struct Crossings {
    std::size_t triangles = 0;  // an edge of another passes through them, or one of theirs through another
    std::size_t pairs = 0;      // of triangles that do so, counted from both sides
};

/// Triangles that touch, share an edge or lie upon each other do not count, nor more than 256 around one. The same on
/// every machine; its time grows as n for a surface whose triangles do not pile up.
Crossings crossingsOf(const geometry::TriangleMesh& mesh);

}  // namespace passung::importer
