#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"

namespace passung::geometry {

/// One side of one triangle.
struct HalfEdge {
    std::uint32_t low, high, triangle;  // low < high: the vertices
    bool forward;                       // the triangle runs from low to high
    bool sameEdge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// Sorted, so that the uses of one edge stand together.
std::vector<HalfEdge> halfEdges(const std::vector<Triangle>& triangles);

/// Calls use(first, count) for each edge with the half edges that lie on it.
template <class Use>
void forEachEdge(const std::vector<HalfEdge>& edges, Use use) {
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].sameEdge(edges[i])) ++end;
        use(&edges[i], end - i);
        i = end;
    }
}

inline constexpr double kSharpCosine = 0.9;  // an edge is sharp if its faces turn by more than 26°

struct SharpEdge {
    HalfEdge edge;  // of its first triangle
    Vec3 normal;    // sum of its triangles' unit normals
    bool inner;     // of a groove: both triangles rise above each other
};

/// Edges where the surface turns by more than 26° or ends, or where more than two triangles meet. Triangles without
/// area do not count.
std::vector<SharpEdge> sharpEdges(const TriangleMesh& mesh);

/// Union-find over 0 … n-1.
class Groups {
public:
    explicit Groups(std::size_t n);
    std::uint32_t find(std::uint32_t i);
    void join(std::uint32_t a, std::uint32_t b);

private:
    std::vector<std::uint32_t> parent_;
};

/// The triangles of each patch that hangs together by edges of two triangles, patches and triangles in the order of the
/// mesh.
std::vector<std::vector<std::uint32_t>> patchesOf(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges);

}  // namespace passung::geometry
