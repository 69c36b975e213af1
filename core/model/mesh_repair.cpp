#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/model/hole_closing.h"
#include "core/model/mesh_import.h"
#include "core/model/triangle_tree.h"

namespace passung::model {

namespace {

/// A triangle is without area if its doubled area is below this share of its longest edge squared: what rounding leaves
/// of three points in a line, far below anything that a part is made of.
constexpr double kFlat = 1e-12;

constexpr double kInsideBalance = 0.5;  // halfway between a sheet (0) and a solid (1)

constexpr std::uint32_t kNone = ~0u;

/// One side of one triangle.
struct HalfEdge {
    std::uint32_t low, high, triangle;  // low < high: the vertices
    bool forward;                       // the triangle runs from low to high
    bool sameEdge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

/// Sorted, so that the uses of one edge stand together.
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

/// Union-find over 0 … n-1.
class Groups {
public:
    explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Joins vertices at equal positions and drops unused ones; vertices keep the order in which triangles name them.
/// Returns how many used vertices were joined to another.
std::size_t weld(TriangleMesh& mesh) {
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Vec3& v = mesh.vertices[i];
        return std::tuple(v.x(), v.y(), v.z());
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<std::uint32_t> first_at(mesh.vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k)
        first_at[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? first_at[order[k - 1]] : order[k];

    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kNone);
    std::vector<char> used(mesh.vertices.size(), 0);
    std::vector<Vec3> kept;
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) {
            used[v] = 1;
            const std::uint32_t representative = first_at[v];
            if (renamed[representative] == kNone) {
                renamed[representative] = static_cast<std::uint32_t>(kept.size());
                kept.push_back(mesh.vertices[representative]);
            }
            v = renamed[representative];
        }
    }
    const auto used_count = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
    const std::size_t joined = used_count - kept.size();
    mesh.vertices = std::move(kept);
    return joined;
}

bool isFlat(const TriangleMesh& mesh, const Triangle& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() <= kFlat * longest2;
}

void dropFlatTriangles(TriangleMesh& mesh, MeshReport& report) {
    report.degenerate_triangles = std::erase_if(mesh.triangles, [&](const Triangle& t) { return isFlat(mesh, t); });
}

void dropDuplicates(TriangleMesh& mesh, MeshReport& report) {
    std::vector<std::pair<Triangle, std::uint32_t>> corners(mesh.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {mesh.triangles[i], static_cast<std::uint32_t>(i)};
        std::sort(corners[i].first.begin(), corners[i].first.end());
    }
    std::sort(corners.begin(), corners.end());
    std::vector<char> drop(mesh.triangles.size(), 0);
    for (std::size_t k = 1; k < corners.size(); ++k)
        if (corners[k].first == corners[k - 1].first) drop[corners[k].second] = 1;
    std::vector<Triangle> kept;
    for (std::size_t i = 0; i < drop.size(); ++i)
        if (drop[i] == 0) kept.push_back(mesh.triangles[i]);
    report.duplicate_triangles = mesh.triangles.size() - kept.size();
    mesh.triangles = std::move(kept);
}

void countEdges(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report) {
    Groups chains(mesh.vertices.size());
    Groups pieces(mesh.triangles.size());
    std::vector<std::uint32_t> border;  // a vertex of each boundary edge
    forEachEdge(edges, [&](const HalfEdge* use, std::size_t count) {
        for (std::size_t k = 1; k < count; ++k) pieces.join(use[0].triangle, use[k].triangle);
        if (count == 1) {
            ++report.boundary_edges;
            chains.join(use->low, use->high);
            border.push_back(use->low);
        }
        if (count > 2) ++report.non_manifold_edges;
        if (count == 2 && use[0].forward == use[1].forward) ++report.inconsistent_edges;
    });
    std::vector<char> seen(mesh.vertices.size(), 0);
    for (const std::uint32_t v : border) {
        char& chain = seen[chains.find(v)];
        report.holes += chain == 0 ? 1 : 0;
        chain = 1;
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) report.shells += pieces.find(i) == i ? 1 : 0;
}

/// Makes neighbours agree: every patch that hangs together by edges of two triangles is walked through, each triangle
/// is marked as agreeing with the first one or not, and the smaller party is turned. (A one-sided surface keeps a
/// seam.)
void turnQuarrellingTriangles(TriangleMesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report) {
    struct Neighbour {
        std::uint32_t triangle = kNone;
        bool quarrels = false;
    };
    std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
    const auto link = [&](std::uint32_t from, Neighbour to) {
        for (Neighbour& slot : neighbours[from]) {
            if (slot.triangle != kNone) continue;
            slot = to;
            return;
        }
    };
    forEachEdge(edges, [&](const HalfEdge* use, std::size_t count) {
        if (count != 2) return;
        const bool quarrels = use[0].forward == use[1].forward;
        link(use[0].triangle, {use[1].triangle, quarrels});
        link(use[1].triangle, {use[0].triangle, quarrels});
    });

    std::vector<signed char> against(mesh.triangles.size(), -1);  // -1: not seen yet
    std::vector<std::uint32_t> patch;
    for (std::uint32_t start = 0; start < mesh.triangles.size(); ++start) {
        if (against[start] >= 0) continue;
        patch.assign(1, start);
        against[start] = 0;
        std::size_t opponents = 0;
        for (std::size_t k = 0; k < patch.size(); ++k) {
            for (const Neighbour& next : neighbours[patch[k]]) {
                if (next.triangle == kNone || against[next.triangle] >= 0) continue;
                against[next.triangle] = static_cast<signed char>(against[patch[k]] ^ (next.quarrels ? 1 : 0));
                opponents += against[next.triangle] == 1 ? 1 : 0;
                patch.push_back(next.triangle);
            }
        }
        const signed char smaller = 2 * opponents > patch.size() ? 0 : 1;
        for (const std::uint32_t i : patch) {
            if (against[i] != smaller) continue;
            std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
            ++report.turned_triangles;
        }
    }
}

bool isWatertight(const std::vector<HalfEdge>& edges) {
    bool tight = !edges.empty();
    forEachEdge(edges, [&](const HalfEdge* use, std::size_t count) {
        if (count != 2 || use[0].forward == use[1].forward) tight = false;
    });
    return tight;
}

/// The edges that are not used as often in one direction as in the other; each runs as a triangle on its free side
/// would.
std::vector<DirectedEdge> openEdges(const std::vector<HalfEdge>& edges) {
    std::vector<DirectedEdge> open;
    forEachEdge(edges, [&](const HalfEdge* use, std::size_t count) {
        int balance = 0;
        for (std::size_t k = 0; k < count; ++k) balance += use[k].forward ? 1 : -1;
        for (; balance > 0; --balance) open.push_back({use->high, use->low});
        for (; balance < 0; ++balance) open.push_back({use->low, use->high});
    });
    return open;
}

void turnAll(TriangleMesh& mesh, std::vector<DirectedEdge>& open, MeshReport& report) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    for (DirectedEdge& edge : open) std::swap(edge[0], edge[1]);
    report.turned_inside_out = true;
}

/// By the divergence theorem, about the middle of the mesh for the sake of rounding.
double enclosedVolume(const TriangleMesh& mesh, const Vec3& middle) {
    double six_volumes = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - middle, b = mesh.vertices[t[1]] - middle, c = mesh.vertices[t[2]] - middle;
        six_volumes += a.dot(b.cross(c));
    }
    return six_volumes / 6.0;
}

double surfaceArea(const TriangleMesh& mesh) {
    double two_areas = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        two_areas += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    }
    return 0.5 * two_areas;
}

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

void writeNotes(MeshReport& r) {
    const auto note = [&](std::size_t n, const std::string& one, const std::string& many) {
        if (n > 0) r.notes.push_back(counted(n, one, many));
    };
    note(r.degenerate_triangles, "triangle had no area and was dropped.", "triangles had no area and were dropped.");
    note(r.duplicate_triangles, "triangle repeated the corners of another and was dropped.",
         "triangles repeated the corners of another and were dropped.");
    note(r.inconsistent_edges, "edge had neighbours of opposite orientation.",
         "edges had neighbours of opposite orientation.");
    note(r.turned_triangles, "triangle was turned to agree with its neighbours.",
         "triangles were turned to agree with their neighbours.");
    if (r.boundary_edges > 0)
        r.notes.push_back("The surface is open: " + counted(r.boundary_edges, "edge", "edges") +
                          " of one triangle only, in " + counted(r.holes, "chain", "chains") + ".");
    note(r.non_manifold_edges, "edge belongs to three or more triangles; left as it is.",
         "edges belong to three or more triangles; left as they are.");
    if (r.turned_inside_out) r.notes.push_back("The surface was inside out: all triangles were turned.");
    if (r.closed_holes > 0)
        r.notes.push_back(counted(r.closed_holes, "hole was", "holes were") + " closed with " +
                          counted(r.closing_triangles, "triangle.", "triangles."));
    if (r.kind == SurfaceKind::HoledSolid)
        r.notes.push_back(counted(r.open_edges_left, "open edge was", "open edges were") +
                          " left: the winding number decides what is inside, and no error bound of a distance field is "
                          "proven.");
    if (r.kind == SurfaceKind::OpenSheet && r.triangles > 0)
        r.notes.push_back(
            "The surface has no inside: it is treated as a sheet, felt on both sides one cell of the distance field in "
            "front of it.");
}

/// Decides what is inside, turns a surface that is inside out, closes holes.
void settleInside(TriangleMesh& mesh, std::vector<DirectedEdge> open, const Bounds& bounds, MeshReport& report) {
    if (mesh.triangles.empty()) return;
    if (open.empty()) {
        report.kind = SurfaceKind::Solid;
        if (enclosedVolume(mesh, 0.5 * (bounds.low + bounds.high)) < 0.0) turnAll(mesh, open, report);
    } else {
        const TriangleTree tree(mesh);
        const double balance = insideBalance(mesh, tree);
        if (!(std::abs(balance) > kInsideBalance)) return;
        if (balance < 0.0) turnAll(mesh, open, report);
        const HoleClosing closing = closeHoles(mesh, open, tree, balance < 0.0 ? -1.0 : 1.0);
        report.closed_holes = closing.holes;
        report.closing_triangles = closing.triangles;
        report.open_edges_left = closing.edges_left;
        report.kind = closing.edges_left == 0 ? SurfaceKind::Solid : SurfaceKind::HoledSolid;
    }
    if (report.kind == SurfaceKind::Solid) report.volume = enclosedVolume(mesh, 0.5 * (bounds.low + bounds.high));
}

}  // namespace

ImportedMesh repairMesh(TriangleMesh mesh) {
    MeshReport report;
    report.triangles_read = mesh.triangles.size();
    report.welded_vertices = weld(mesh);
    dropFlatTriangles(mesh, report);
    dropDuplicates(mesh, report);
    weld(mesh);  // vertices of dropped triangles only

    std::vector<HalfEdge> edges = halfEdges(mesh.triangles);
    countEdges(mesh, edges, report);
    if (report.inconsistent_edges > 0) {
        turnQuarrellingTriangles(mesh, edges, report);
        edges = halfEdges(mesh.triangles);
    }
    report.watertight = isWatertight(edges);
    const Bounds bounds = boundsOf(mesh);
    report.area = surfaceArea(mesh);
    report.size = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : bounds.size();
    report.triangles = mesh.triangles.size();
    report.vertices = mesh.vertices.size();
    settleInside(mesh, openEdges(edges), bounds, report);
    writeNotes(report);
    return {std::move(mesh), std::move(report)};
}

}  // namespace passung::model
