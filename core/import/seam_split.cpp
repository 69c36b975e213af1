#include "core/import/seam_split.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "core/geometry/mesh_edges.h"
#include "core/geometry/triangle_tree.h"

namespace passung::importer {

namespace {

using geometry::Triangle;

/// A vertex on an edge of a triangle.
struct Split {
    std::uint32_t triangle;
    std::size_t side;  // the edge from this corner to the next
    double along;      // from that corner [m]
    std::uint32_t vertex;

    auto place() const { return std::tuple(triangle, side, along, vertex); }
};

/// The edges of one triangle only, and their vertices.
struct Border {
    std::vector<geometry::HalfEdge> edges;
    std::vector<std::uint32_t> vertices;
};

Border borderOf(const geometry::TriangleMesh& mesh) {
    Border border;
    geometry::forEachEdge(geometry::halfEdges(mesh.triangles), [&](const geometry::HalfEdge* use, std::size_t count) {
        if (count != 1) return;
        border.edges.push_back(*use);
        border.vertices.push_back(use->low);
        border.vertices.push_back(use->high);
    });
    std::sort(border.vertices.begin(), border.vertices.end());
    border.vertices.erase(std::unique(border.vertices.begin(), border.vertices.end()), border.vertices.end());
    return border;
}

/// Which side of the triangle the edge is.
std::size_t sideOf(const Triangle& t, const geometry::HalfEdge& edge) {
    const std::uint32_t from = edge.forward ? edge.low : edge.high;
    return t[0] == from ? 0 : t[1] == from ? 1 : 2;
}

std::vector<Split> findSplits(const geometry::TriangleMesh& mesh, const Border& border, double reach) {
    geometry::TriangleMesh lines;  // the edges, as triangles without area
    lines.vertices = mesh.vertices;
    for (const geometry::HalfEdge& edge : border.edges) lines.triangles.push_back({edge.low, edge.high, edge.high});
    const geometry::TriangleTree tree(lines);
    std::vector<Split> splits;
    std::vector<std::uint32_t> found;
    for (const std::uint32_t v : border.vertices) {
        const Vec3& p = mesh.vertices[v];
        found.clear();
        tree.findNear(p, reach, found);
        for (const std::uint32_t place : found) {
            const geometry::HalfEdge& edge = border.edges[tree.numberOf(place)];
            const Triangle& t = mesh.triangles[edge.triangle];
            if (t[0] == v || t[1] == v || t[2] == v) continue;
            const std::size_t side = sideOf(t, edge);
            const Vec3 &from = mesh.vertices[t[side]], &to = mesh.vertices[t[(side + 1) % 3]];
            const double length = (to - from).norm(), along = (p - from).dot(to - from) / length;
            if (!(along > reach && along < length - reach)) continue;
            if ((p - from - along / length * (to - from)).norm() > reach) continue;
            splits.push_back({edge.triangle, side, along, v});
        }
    }
    std::sort(splits.begin(), splits.end(), [](const Split& a, const Split& b) { return a.place() < b.place(); });
    return splits;
}

/// Cuts a triangle at the vertices on its sides: a fan from the corner across the first side that has any; the two
/// other sides belong to the ends of that fan, and a fan from a vertex of the first side cuts them.
void cut(const Triangle& t, const std::array<std::vector<std::uint32_t>, 3>& on_side, std::vector<Triangle>& pieces) {
    const std::size_t first = !on_side[0].empty() ? 0 : !on_side[1].empty() ? 1 : 2;
    const auto corner = [&](std::size_t k) { return t[(first + k) % 3]; };
    const auto chainOf = [&](std::size_t k) {
        std::vector<std::uint32_t> chain{corner(k)};
        const auto& on = on_side[(first + k) % 3];
        chain.insert(chain.end(), on.begin(), on.end());
        chain.push_back(corner(k + 1));
        return chain;
    };
    const std::vector<std::uint32_t> chain = chainOf(0), after = chainOf(1), before = chainOf(2);
    const auto fan = [&](const std::vector<std::uint32_t>& along, std::uint32_t apex) {
        for (std::size_t i = 0; i + 1 < along.size(); ++i) pieces.push_back({along[i], along[i + 1], apex});
    };
    fan(before, chain[1]);
    for (std::size_t i = 1; i + 2 < chain.size(); ++i) pieces.push_back({chain[i], chain[i + 1], corner(2)});
    fan(after, chain[chain.size() - 2]);
}

}  // namespace

std::size_t splitSeams(geometry::TriangleMesh& mesh, double reach) {
    const Border border = borderOf(mesh);
    if (border.edges.empty()) return 0;
    const std::vector<Split> splits = findSplits(mesh, border, reach);
    if (splits.empty()) return 0;
    std::vector<Triangle> pieces;
    for (std::size_t i = 0, k = 0; i < mesh.triangles.size(); ++i) {
        std::array<std::vector<std::uint32_t>, 3> on_side;
        bool whole = true;
        for (; k < splits.size() && splits[k].triangle == i; ++k) {
            on_side[splits[k].side].push_back(splits[k].vertex);
            whole = false;
        }
        if (whole)
            pieces.push_back(mesh.triangles[i]);
        else
            cut(mesh.triangles[i], on_side, pieces);
    }
    mesh.triangles = std::move(pieces);
    return splits.size();
}

}  // namespace passung::importer
