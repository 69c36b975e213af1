#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"

namespace passung::geometry {

/// A convex face: corners in order; triangles without area keep theirs as they are.
struct ConvexFace {
    std::vector<std::uint32_t> corners;
    std::uint32_t triangle = 0;  // the first of the mesh that it is made of
};

/// Faces over welded vertices. The convex hulls of their corners hold every triangle of the mesh, up to kWelded.
struct ConvexFaces {
    std::vector<Vec3> vertices;  // part frame [m]
    std::vector<ConvexFace> faces;
};

inline constexpr double kWelded = 2e-11;   // [m]: vertices nearer than half of this are one
inline constexpr double kFlatFace = 1e-8;  // [m]: how far the corners of a face may lie from its first triangle's plane

/// Triangles of one plane that hang together become convex faces as large as they grow greedily: a face then costs one
/// look instead of hundreds. Nothing is asked of the mesh: seams, gaps, T-junctions and triangles without area are left
/// as they are.
ConvexFaces mergeFlatTriangles(const TriangleMesh& mesh);

}  // namespace passung::geometry
