#include "tests/bench/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace passung::bench {

namespace {

/// One edge: the corners opposite to it, and where its new vertex is.
struct Edge {
    Vec3 opposite = Vec3::Zero();  // sum over its triangles
    std::uint32_t vertex = 0;
};

double neighbourWeight(double valence) {
    const double c = 0.375 + 0.25 * std::cos(2.0 * std::numbers::pi / valence);
    return (0.625 - c * c) / valence;
}

}  // namespace

geometry::TriangleMesh subdivideLoop(const geometry::TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
    const auto edgeOf = [&](std::uint32_t a, std::uint32_t b) -> Edge& {
        return edges[{std::min(a, b), std::max(a, b)}];
    };
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) edgeOf(t[k], t[(k + 1) % 3]).opposite += mesh.vertices[t[(k + 2) % 3]];

    geometry::TriangleMesh fine;
    std::vector<Vec3> neighbours(mesh.vertices.size(), Vec3::Zero());
    std::vector<double> valence(mesh.vertices.size(), 0.0);
    std::vector<Vec3> middles;
    for (auto& [ends, edge] : edges) {
        const Vec3 &a = mesh.vertices[ends.first], &b = mesh.vertices[ends.second];
        neighbours[ends.first] += b;
        neighbours[ends.second] += a;
        valence[ends.first] += 1.0;
        valence[ends.second] += 1.0;
        edge.vertex = static_cast<std::uint32_t>(mesh.vertices.size() + middles.size());
        middles.push_back(0.375 * (a + b) + 0.125 * edge.opposite);
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const double beta = valence[i] > 0.0 ? neighbourWeight(valence[i]) : 0.0;
        fine.vertices.push_back((1.0 - valence[i] * beta) * mesh.vertices[i] + beta * neighbours[i]);
    }
    fine.vertices.insert(fine.vertices.end(), middles.begin(), middles.end());
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = edgeOf(a, b).vertex, bc = edgeOf(b, c).vertex, ca = edgeOf(c, a).vertex;
        fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return fine;
}

}  // namespace passung::bench
