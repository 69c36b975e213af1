#include "core/import/hole_closing.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace passung::importer {

namespace {

constexpr std::size_t kSampledTriangles = 500;
constexpr double kBeside = 1e-5;        // of the part's size: how far beside a triangle the winding number is asked for
constexpr double kFanBeside = 1e-3;     // the same, of the height of a fan's triangle
constexpr double kFlatTriangle = 1e-9;  // height over longest edge: no area that a winding number could tell
constexpr double kHalfwayBand = 0.25;   // a winding number this near to ½ lies between inside and outside
constexpr std::uint32_t kNowhere = ~0u;

using Loop = std::vector<std::uint32_t>;

Vec3 areaVector(const std::vector<Vec3>& vertices, const geometry::Triangle& t) {
    const Vec3& a = vertices[t[0]];
    return 0.5 * (vertices[t[1]] - a).cross(vertices[t[2]] - a);
}

Vec3 centroid(const std::vector<Vec3>& vertices, const geometry::Triangle& t) {
    return (vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3.0;
}

/// A closed surface is left as often as it is entered at every vertex, hence so are the edges that it lacks: a walk
/// along them ends where it began. Whenever it meets itself, the part between is a loop.
std::vector<Loop> simpleLoops(std::vector<DirectedEdge> edges, std::size_t vertex_count) {
    std::sort(edges.begin(), edges.end());
    std::vector<std::size_t> next(vertex_count + 1, 0);  // the first edge from each vertex that was not walked yet
    for (const DirectedEdge& edge : edges) ++next[edge[0] + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) next[v + 1] += next[v];
    const std::vector<std::size_t> end(next.begin() + 1, next.end());

    std::vector<Loop> loops;
    std::vector<std::uint32_t> place(vertex_count, kNowhere);  // on the path
    Loop path;
    for (const DirectedEdge& first : edges) {
        path.assign(1, first[0]);
        place[first[0]] = 0;
        while (next[path.back()] < end[path.back()]) {
            const std::uint32_t to = edges[next[path.back()]++][1];
            if (place[to] == kNowhere) {
                place[to] = static_cast<std::uint32_t>(path.size());
                path.push_back(to);
                continue;
            }
            const auto from = path.begin() + static_cast<std::ptrdiff_t>(place[to]);
            loops.emplace_back(from, path.end());
            for (auto v = from + 1; v != path.end(); ++v) place[*v] = kNowhere;
            path.erase(from + 1, path.end());
        }
        place[first[0]] = kNowhere;
    }
    return loops;
}

/// One triangle, or a fan about a new vertex (the last of `vertices` then): a diagonal might be an edge of the mesh
/// already.
std::vector<geometry::Triangle> fanOf(const Loop& loop, std::vector<Vec3>& vertices) {
    if (loop.size() == 3) return {{loop[0], loop[1], loop[2]}};
    Vec3 moment = Vec3::Zero();
    double length = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 &a = vertices[loop[k]], &b = vertices[loop[(k + 1) % loop.size()]];
        moment += (b - a).norm() * 0.5 * (a + b);
        length += (b - a).norm();
    }
    const auto middle = static_cast<std::uint32_t>(vertices.size());
    vertices.emplace_back(moment / length);
    std::vector<geometry::Triangle> fan;
    for (std::size_t k = 0; k < loop.size(); ++k) fan.push_back({loop[k], loop[(k + 1) % loop.size()], middle});
    return fan;
}

enum class Gap {
    Hole,   // the winding number is about ½ on both sides of most of the fan's area
    Seam,   // the fan has no area: open by name only (a vertex on a neighbour's edge)
    Crack,  // no place for a fan
};

Gap gapOf(const std::vector<geometry::Triangle>& fan, const std::vector<Vec3>& vertices,
          const geometry::TriangleTree& tree, double facing) {
    double halfway_area = 0.0, total_area = 0.0;
    for (const geometry::Triangle& t : fan) {
        const Vec3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        const Vec3 area = areaVector(vertices, t);
        const double height = 2.0 * area.norm() / longest;
        if (!(height > kFlatTriangle * longest)) continue;
        const Vec3 beside = kFanBeside * height * area.normalized();
        bool halfway = true;
        for (const double side : {1.0, -1.0}) {
            const double w = facing * tree.windingNumber(centroid(vertices, t) + side * beside);
            halfway = halfway && std::abs(w - 0.5) < kHalfwayBand;
        }
        total_area += area.norm();
        if (halfway) halfway_area += area.norm();
    }
    if (!(total_area > 0.0)) return Gap::Seam;
    return halfway_area >= 0.5 * total_area ? Gap::Hole : Gap::Crack;
}

}  // namespace

double insideBalance(const geometry::TriangleMesh& mesh, const geometry::TriangleTree& tree) {
    const double step = kBeside * boundsOf(mesh).size().norm();
    const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / kSampledTriangles);
    double balance = 0.0, total_area = 0.0;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        const geometry::Triangle& t = mesh.triangles[i];
        const Vec3 area = areaVector(mesh.vertices, t), middle = centroid(mesh.vertices, t);
        const Vec3 beside = step * area.normalized();
        balance += area.norm() * (tree.windingNumber(middle - beside) + tree.windingNumber(middle + beside));
        total_area += area.norm();
    }
    return balance / total_area;
}

HoleClosing closeHoles(geometry::TriangleMesh& mesh, const std::vector<DirectedEdge>& open_edges,
                       const geometry::TriangleTree& tree, double facing) {
    HoleClosing result;
    for (const Loop& loop : simpleLoops(open_edges, mesh.vertices.size())) {
        const std::size_t vertices_before = mesh.vertices.size();
        const std::vector<geometry::Triangle> fan = fanOf(loop, mesh.vertices);
        const Gap gap = gapOf(fan, mesh.vertices, tree, facing);
        if (gap == Gap::Crack) {
            mesh.vertices.resize(vertices_before);
            result.edges_left += loop.size();
            continue;
        }
        mesh.triangles.insert(mesh.triangles.end(), fan.begin(), fan.end());
        ++(gap == Gap::Hole ? result.holes : result.seams);
        result.triangles += fan.size();
    }
    return result;
}

}  // namespace passung::importer
