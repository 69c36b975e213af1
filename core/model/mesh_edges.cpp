#include "core/model/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace passung::model {

std::vector<HalfEdge> halfEdges(const std::vector<Triangle>& triangles) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = triangles[i][k], to = triangles[i][(k + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(i), from < to});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return edges;
}

Groups::Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

std::uint32_t Groups::find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void Groups::join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
}

std::vector<std::vector<std::uint32_t>> patchesOf(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges) {
    Groups groups(mesh.triangles.size());
    forEachEdge(edges, [&](const HalfEdge* use, std::size_t count) {
        if (count == 2) groups.join(use[0].triangle, use[1].triangle);
    });
    std::vector<std::vector<std::uint32_t>> patches;
    std::vector<std::size_t> patch_of(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t first = groups.find(i);
        if (first == i) {
            patch_of[i] = patches.size();
            patches.emplace_back();
        }
        patches[patch_of[first]].push_back(i);
    }
    return patches;
}

}  // namespace passung::model
