#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace passung::geometry {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices; part frame, metres, outward normals by the right-hand rule.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
};

/// Axis-aligned bounds.
struct Bounds {
    Vec3 low = Vec3::Constant(1e300);
    Vec3 high = Vec3::Constant(-1e300);
    void extend(const Vec3& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    Vec3 size() const { return high - low; }
};

Bounds boundsOf(const TriangleMesh& mesh);

/// FNV-1a over the counts, the exact bits of all vertices and all triangles, in order: two meshes with the same hash
/// are the same geometry. The same on every machine. A shape is identified by the hash of its tessellation.
std::uint64_t contentHash(const TriangleMesh& mesh);

}  // namespace passung::geometry
