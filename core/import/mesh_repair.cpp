#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/hash_mix.h"
#include "core/geometry/mesh_edges.h"
#include "core/geometry/triangle_tree.h"
#include "core/import/hole_closing.h"
#include "core/import/mesh_import.h"
#include "core/import/patch_orientation.h"
#include "core/import/seam_split.h"
#include "core/import/self_intersection.h"

namespace passung::importer {

namespace {

/// A triangle is without area if its doubled area is below this share of its longest edge squared: what rounding leaves
/// of three points in a line, far below anything that a part is made of.
constexpr double kFlat = 1e-12;

/// Of the mesh's size: vertices of open edges closer than this are one, and lie on an open edge closer than this.
constexpr double kNear = 1e-6;
constexpr int kSeamRounds = 4;  // of splitting: what is dropped afterwards may open an edge

constexpr double kUnusuallyLong = 10.0, kUnusuallyShort = 1e-4;  // [m]

constexpr double kInsideBalance = 0.5;  // halfway between a sheet (0) and a solid (1)

constexpr std::uint32_t kNoIndex = ~0u;

/// Lets triangles name `first_at[v]` in place of v and drops unused vertices; vertices keep the order in which
/// triangles name them. Returns how many used vertices were joined to another.
std::size_t join(geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& first_at) {
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kNoIndex);
    std::vector<char> used(mesh.vertices.size(), 0);
    std::vector<Vec3> kept;
    for (geometry::Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) {
            used[v] = 1;
            const std::uint32_t representative = first_at[v];
            if (renamed[representative] == kNoIndex) {
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

/// The first vertex at each position that is asked for; a hash table with linear probing.
class FirstAt {
public:
    explicit FirstAt(const std::vector<Vec3>& vertices)
        : vertices_(vertices), slots_(std::bit_ceil(2 * vertices.size() + 1), kNoIndex) {}

    /// `v` itself if none before it was there.
    std::uint32_t of(std::uint32_t v) {
        std::size_t slot = static_cast<std::size_t>(hash(vertices_[v])) & (slots_.size() - 1);
        while (slots_[slot] != kNoIndex && vertices_[slots_[slot]] != vertices_[v])
            slot = (slot + 1) & (slots_.size() - 1);
        if (slots_[slot] == kNoIndex) slots_[slot] = v;
        return slots_[slot];
    }

private:
    static std::uint64_t hash(const Vec3& p) {
        std::uint64_t h = 0;
        for (const double x : p) h = hashMix(h, std::bit_cast<std::uint64_t>(x + 0.0));  // -0 lies where 0 does
        return h;
    }

    const std::vector<Vec3>& vertices_;
    std::vector<std::uint32_t> slots_;
};

/// Joins vertices at equal positions.
std::size_t weld(geometry::TriangleMesh& mesh) {
    FirstAt first(mesh.vertices);
    std::vector<std::uint32_t> first_at(mesh.vertices.size());
    for (std::uint32_t v = 0; v < first_at.size(); ++v) first_at[v] = first.of(v);
    return join(mesh, first_at);
}

/// Joins vertices of open edges that are nearly at one place, as rounding leaves them when every triangle is written on
/// its own: closer than kNear of the mesh's size, to the first of them along x, so that nothing creeps on.
std::size_t weldNear(geometry::TriangleMesh& mesh, double reach) {
    std::vector<std::uint32_t> border;
    geometry::forEachEdge(geometry::halfEdges(mesh.triangles), [&](const geometry::HalfEdge* use, std::size_t count) {
        if (count != 1) return;
        border.push_back(use->low);
        border.push_back(use->high);
    });
    const auto key = [&](std::uint32_t i) { return std::pair(mesh.vertices[i].x(), i); };
    std::sort(border.begin(), border.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    border.erase(std::unique(border.begin(), border.end()), border.end());
    if (border.empty()) return 0;
    std::vector<std::uint32_t> first_at(mesh.vertices.size());
    std::iota(first_at.begin(), first_at.end(), 0u);
    for (std::size_t k = 0; k < border.size(); ++k) {
        if (first_at[border[k]] != border[k]) continue;
        const Vec3& here = mesh.vertices[border[k]];
        for (std::size_t i = k + 1; i < border.size() && mesh.vertices[border[i]].x() - here.x() <= reach; ++i)
            if (first_at[border[i]] == border[i] && (mesh.vertices[border[i]] - here).norm() <= reach)
                first_at[border[i]] = border[k];
    }
    return join(mesh, first_at);
}

bool isFlat(const geometry::TriangleMesh& mesh, const geometry::Triangle& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() <= kFlat * longest2;
}

void dropFlatTriangles(geometry::TriangleMesh& mesh, MeshReport& report) {
    report.degenerate_triangles +=
        std::erase_if(mesh.triangles, [&](const geometry::Triangle& t) { return isFlat(mesh, t); });
}

void dropDuplicates(geometry::TriangleMesh& mesh, MeshReport& report) {
    std::vector<std::pair<geometry::Triangle, std::uint32_t>> corners(mesh.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {mesh.triangles[i], static_cast<std::uint32_t>(i)};
        std::sort(corners[i].first.begin(), corners[i].first.end());
    }
    std::sort(corners.begin(), corners.end());
    std::vector<char> drop(mesh.triangles.size(), 0);
    for (std::size_t k = 1; k < corners.size(); ++k)
        if (corners[k].first == corners[k - 1].first) drop[corners[k].second] = 1;
    std::vector<geometry::Triangle> kept;
    for (std::size_t i = 0; i < drop.size(); ++i)
        if (drop[i] == 0) kept.push_back(mesh.triangles[i]);
    report.duplicate_triangles += mesh.triangles.size() - kept.size();
    mesh.triangles = std::move(kept);
}

/// Equal vertices become one, then nearly equal ones of open edges, then these edges are split where others end on
/// them; what has no area or is there twice goes.
void weldAll(geometry::TriangleMesh& mesh, MeshReport& report) {
    const auto drop = [&] {
        dropFlatTriangles(mesh, report);
        dropDuplicates(mesh, report);
        return weld(mesh);  // vertices of dropped triangles only
    };
    report.welded_vertices = weld(mesh);
    drop();
    const double reach = kNear * boundsOf(mesh).size().norm();
    report.joined_vertices = weldNear(mesh, reach);
    if (report.joined_vertices > 0) drop();
    for (int round = 0; round < kSeamRounds; ++round) {
        const std::size_t splits = splitSeams(mesh, reach);
        if (splits == 0) return;
        report.split_edges += splits;
        drop();
    }
}

void countEdges(const geometry::TriangleMesh& mesh, const std::vector<geometry::HalfEdge>& edges, MeshReport& report) {
    geometry::Groups chains(mesh.vertices.size());
    geometry::Groups pieces(mesh.triangles.size());
    std::vector<std::uint32_t> border;  // a vertex of each boundary edge
    geometry::forEachEdge(edges, [&](const geometry::HalfEdge* use, std::size_t count) {
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
void turnQuarrellingTriangles(geometry::TriangleMesh& mesh, const std::vector<geometry::HalfEdge>& edges,
                              MeshReport& report) {
    struct Neighbour {
        std::uint32_t triangle = kNoIndex;
        bool quarrels = false;
    };
    std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
    const auto link = [&](std::uint32_t from, Neighbour to) {
        for (Neighbour& slot : neighbours[from]) {
            if (slot.triangle != kNoIndex) continue;
            slot = to;
            return;
        }
    };
    geometry::forEachEdge(edges, [&](const geometry::HalfEdge* use, std::size_t count) {
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
                if (next.triangle == kNoIndex || against[next.triangle] >= 0) continue;
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

bool isWatertight(const std::vector<geometry::HalfEdge>& edges) {
    bool tight = !edges.empty();
    geometry::forEachEdge(edges, [&](const geometry::HalfEdge* use, std::size_t count) {
        if (count != 2 || use[0].forward == use[1].forward) tight = false;
    });
    return tight;
}

/// The edges that are not used as often in one direction as in the other; each runs as a triangle on its free side
/// would.
std::vector<DirectedEdge> openEdges(const std::vector<geometry::HalfEdge>& edges) {
    std::vector<DirectedEdge> open;
    geometry::forEachEdge(edges, [&](const geometry::HalfEdge* use, std::size_t count) {
        int balance = 0;
        for (std::size_t k = 0; k < count; ++k) balance += use[k].forward ? 1 : -1;
        for (; balance > 0; --balance) open.push_back({use->high, use->low});
        for (; balance < 0; ++balance) open.push_back({use->low, use->high});
    });
    return open;
}

void turnAll(geometry::TriangleMesh& mesh, std::vector<DirectedEdge>& open, MeshReport& report) {
    for (geometry::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    for (DirectedEdge& edge : open) std::swap(edge[0], edge[1]);
    report.turned_inside_out = true;
}

/// By the divergence theorem, about the middle of the mesh for the sake of rounding.
double enclosedVolume(const geometry::TriangleMesh& mesh, const Vec3& middle) {
    double six_volumes = 0.0;
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - middle, b = mesh.vertices[t[1]] - middle, c = mesh.vertices[t[2]] - middle;
        six_volumes += a.dot(b.cross(c));
    }
    return six_volumes / 6.0;
}

double surfaceArea(const geometry::TriangleMesh& mesh) {
    double two_areas = 0.0;
    for (const geometry::Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        two_areas += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    }
    return 0.5 * two_areas;
}

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Says that a part is so large or so small that its unit may not be what its author meant.
void noteUnusualSize(MeshReport& r) {
    const double longest = r.size.maxCoeff();
    if (longest > kUnusuallyLong || (longest > 0.0 && longest < kUnusuallyShort)) {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "The part is %.3g mm long: check its unit.", 1e3 * longest);
        r.notes.emplace_back(text.data());
    }
}

/// Each defect and what was done about it.
void writeNotes(MeshReport& r) {
    const auto note = [&](std::size_t n, const std::string& one, const std::string& many) {
        if (n > 0) r.notes.push_back(counted(n, one, many));
    };
    noteUnusualSize(r);
    note(r.joined_vertices, "vertex of an open edge lay beside another, nearer than a millionth of the size: joined.",
         "vertices of open edges lay beside others, nearer than a millionth of the size: joined.");
    note(r.split_edges, "time an open edge was split at a vertex that lies on it, nearer than a millionth of the size.",
         "times an open edge was split at a vertex that lies on it, nearer than a millionth of the size.");
    note(r.degenerate_triangles, "triangle had no area and was dropped.", "triangles had no area and were dropped.");
    note(r.duplicate_triangles, "triangle repeated the corners of another and was dropped.",
         "triangles repeated the corners of another and were dropped.");
    note(r.inconsistent_edges, "edge had neighbours of opposite orientation.",
         "edges had neighbours of opposite orientation.");
    note(r.turned_triangles, "triangle was turned to agree with its neighbours.",
         "triangles were turned to agree with their neighbours.");
    if (r.turned_patches > 0)
        r.notes.push_back(counted(r.turned_patches, "piece", "pieces") +
                          " without a common edge faced against the rest, by the winding number: " +
                          counted(r.turned_patch_triangles, "triangle was turned.", "triangles were turned."));
    if (r.boundary_edges > 0)
        r.notes.push_back("The surface is open: " + counted(r.boundary_edges, "edge", "edges") +
                          " of one triangle only, in " + counted(r.holes, "chain", "chains") + ".");
    note(r.non_manifold_edges, "edge belongs to three or more triangles; left as it is.",
         "edges belong to three or more triangles; left as they are.");
    if (r.turned_inside_out) r.notes.push_back("The surface was inside out: all triangles were turned.");
    if (r.closed_holes > 0) r.notes.push_back(counted(r.closed_holes, "hole was closed.", "holes were closed."));
    note(r.closed_seams, "seam, where a vertex lies on the edge of a neighbour, was closed.",
         "seams, where vertices lie on the edges of neighbours, were closed.");
    note(r.closing_triangles, "triangle was added for that.", "triangles were added for that.");
    note(r.cavities, "shell inside the solid faces inwards: a cavity.",
         "shells inside a solid face inwards: cavities.");
    note(r.nested_solids,
         "shell inside the solid faces outwards too: solid within solid, no cavity; its faces stay and are felt from "
         "neither side.",
         "shells inside a solid face outwards too: solid within solid, no cavities; their faces stay and are felt from "
         "neither side.");
    note(r.crossing_triangles,
         "triangle passes through another; left: inside is what any piece encloses, and inside of it depth counts to "
         "the "
         "nearest face of any piece.",
         "triangles pass through each other; left: inside is what any piece encloses, and inside of it depth counts to "
         "the nearest face of any piece.");
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
void settleInside(geometry::TriangleMesh& mesh, std::vector<DirectedEdge> open, const geometry::Bounds& bounds,
                  MeshReport& report) {
    if (mesh.triangles.empty()) return;
    if (open.empty()) {
        report.kind = SurfaceKind::Solid;
        if (enclosedVolume(mesh, 0.5 * (bounds.low + bounds.high)) < 0.0) turnAll(mesh, open, report);
    } else {
        const geometry::TriangleTree tree(mesh);
        const double balance = insideBalance(mesh, tree);
        if (!(std::abs(balance) > kInsideBalance)) return;
        if (balance < 0.0) turnAll(mesh, open, report);
        const HoleClosing closing = closeHoles(mesh, open, tree, balance < 0.0 ? -1.0 : 1.0);
        report.closed_holes = closing.holes;
        report.closed_seams = closing.seams;
        report.closing_triangles = closing.triangles;
        report.open_edges_left = closing.edges_left;
        report.kind = closing.edges_left == 0 ? SurfaceKind::Solid : SurfaceKind::HoledSolid;
    }
    if (report.kind == SurfaceKind::Solid) report.volume = enclosedVolume(mesh, 0.5 * (bounds.low + bounds.high));
}

}  // namespace

ImportedMesh repairMesh(geometry::TriangleMesh mesh) {
    MeshReport report;
    report.triangles_read = mesh.triangles.size();
    weldAll(mesh, report);

    std::vector<geometry::HalfEdge> edges = geometry::halfEdges(mesh.triangles);
    countEdges(mesh, edges, report);
    if (report.inconsistent_edges > 0) {
        turnQuarrellingTriangles(mesh, edges, report);
        edges = geometry::halfEdges(mesh.triangles);
    }
    if (const auto pieces = piecesToOrient(mesh, edges); pieces.size() > 1) {
        const PatchOrientation orientation = orientPatches(mesh, pieces);
        report.turned_patches = orientation.turned_patches;
        report.turned_patch_triangles = orientation.turned_triangles;
        report.cavities = orientation.cavities;
        report.nested_solids = orientation.nested_solids;
        report.turned_inside_out = orientation.turned_all;
        if (orientation.turned_all || orientation.turned_patches > 0) edges = geometry::halfEdges(mesh.triangles);
    }
    const Crossings crossings = crossingsOf(mesh);
    report.crossing_triangles = crossings.triangles;
    report.crossing_pairs = crossings.pairs;
    report.watertight = isWatertight(edges);
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    report.area = surfaceArea(mesh);
    report.size = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : bounds.size();
    report.triangles = mesh.triangles.size();
    report.vertices = mesh.vertices.size();
    settleInside(mesh, openEdges(edges), bounds, report);
    writeNotes(report);
    return {std::move(mesh), std::move(report)};
}

}  // namespace passung::importer
