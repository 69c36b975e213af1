#include "core/geometry/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace passung::geometry {

namespace {

/// The corner of a triangle that is not on the edge.
const Vec3& apexOf(const TriangleMesh& mesh, const HalfEdge& edge) {
    for (const std::uint32_t v : mesh.triangles[edge.triangle])
        if (v != edge.low && v != edge.high) return mesh.vertices[v];
    return mesh.vertices[edge.low];
}

}  // namespace

std::vector<HalfEdge> halfEdges(const std::vector<Triangle>& triangles) {
    std::size_t vertices = 0;
    for (const Triangle& t : triangles)
        vertices = std::max({vertices, t[0] + std::size_t{1}, t[1] + std::size_t{1}, t[2] + std::size_t{1}});
    // Each to its lower vertex first: what is left to sort is short.
    std::vector<std::size_t> place(vertices + 1, 0);
    const auto forEach = [&](const auto& use) {
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) use(i, triangles[i][k], triangles[i][(k + 1) % 3]);
    };
    forEach([&](std::size_t, std::uint32_t from, std::uint32_t to) { ++place[std::min(from, to) + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) place[v + 1] += place[v];
    std::vector<HalfEdge> edges(3 * triangles.size());
    forEach([&](std::size_t i, std::uint32_t from, std::uint32_t to) {
        edges[place[std::min(from, to)]++] = {std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(i),
                                              from < to};
    });
    for (std::size_t begin = 0, v = 0; v < vertices; begin = place[v], ++v)
        std::sort(edges.begin() + static_cast<std::ptrdiff_t>(begin),
                  edges.begin() + static_cast<std::ptrdiff_t>(place[v]), [](const HalfEdge& a, const HalfEdge& b) {
                      return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
                  });
    return edges;
}

std::vector<SharpEdge> sharpEdges(const TriangleMesh& mesh) {
    std::vector<Vec3> normals;  // zero: no area
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        normals.push_back((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).stableNormalized());
    }
    std::vector<SharpEdge> sharp;
    forEachEdge(halfEdges(mesh.triangles), [&](const HalfEdge* use, std::size_t count) {
        Vec3 sum = Vec3::Zero();
        std::vector<const HalfEdge*> faces;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3& normal = normals[use[i].triangle];
            if (!(normal.squaredNorm() > 0.0)) continue;
            faces.push_back(&use[i]);
            sum += normal;
        }
        if (faces.empty()) return;
        bool inner = false;
        if (faces.size() == 2) {
            const Vec3 &n = normals[faces[0]->triangle], &m = normals[faces[1]->triangle];
            if (n.dot(m) > kSharpCosine) return;
            const Vec3& on = mesh.vertices[faces[0]->low];
            inner = n.dot(apexOf(mesh, *faces[1]) - on) > 0.0 && m.dot(apexOf(mesh, *faces[0]) - on) > 0.0;
        }
        sharp.push_back({*faces[0], sum, inner});
    });
    return sharp;
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

}  // namespace passung::geometry
