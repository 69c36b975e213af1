#include "core/model/point_shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/base/random.h"
#include "core/model/disk_subset.h"

namespace passung::model {

namespace {

constexpr double kDiskShare = 0.75;  // disk radius per spacing: then neighbours are about one spacing apart
constexpr double kCandidateShare = 0.4;
constexpr double kEdgeShare = 0.5;    // spacing of edge samples per spacing
constexpr double kSharpCosine = 0.9;  // an edge is sharp if its faces turn by more than 26°
constexpr int kRelaxations = 3;
constexpr std::uint64_t kSeed = 20260101;  // of the order in which candidates are tried; any value serves

struct Candidates {
    std::vector<Vec3> positions, normals;
    std::vector<double> areas;
    double reach = 0.0;  // no point of a cut triangle is farther than this from its centroid
};

void cutTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal, double longest, Candidates& out) {
    const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
    if (std::max({ab, bc, ca}) > longest) {
        // Halve the longest edge: the pieces stay as round as the triangle allows.
        if (ab >= bc && ab >= ca) {
            const Vec3 m = 0.5 * (a + b);
            cutTriangle(a, m, c, normal, longest, out);
            cutTriangle(m, b, c, normal, longest, out);
        } else if (bc >= ca) {
            const Vec3 m = 0.5 * (b + c);
            cutTriangle(a, b, m, normal, longest, out);
            cutTriangle(a, m, c, normal, longest, out);
        } else {
            const Vec3 m = 0.5 * (c + a);
            cutTriangle(a, b, m, normal, longest, out);
            cutTriangle(m, b, c, normal, longest, out);
        }
        return;
    }
    const double area = 0.5 * (b - a).cross(c - a).norm();
    if (!(area > 0.0)) return;
    const Vec3 centre = (a + b + c) / 3.0;
    out.positions.push_back(centre);
    out.normals.push_back(normal);
    out.areas.push_back(area);
    out.reach = std::max({out.reach, (a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
}

Vec3 areaVector(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.vertices[t[0]];
    return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

Candidates cutMesh(const TriangleMesh& mesh, double longest) {
    Candidates out;
    for (const auto& t : mesh.triangles) {
        const Vec3 area = areaVector(mesh, t);
        if (!(area.norm() > 0.0)) continue;
        cutTriangle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], area.normalized(), longest, out);
    }
    return out;
}

/// Moves each sample to the candidate of its patch that is nearest to the patch's centroid.
void relax(const Candidates& all, const std::vector<std::uint32_t>& patch, std::vector<std::uint32_t>& samples) {
    std::vector<Vec3> centroid(samples.size(), Vec3::Zero());
    std::vector<double> weight(samples.size(), 0.0);
    for (std::size_t i = 0; i < patch.size(); ++i) {
        centroid[patch[i]] += all.areas[i] * all.positions[i];
        weight[patch[i]] += all.areas[i];
    }
    std::vector<double> best(samples.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < patch.size(); ++i) {
        const std::uint32_t k = patch[i];
        const double d = (all.positions[i] - centroid[k] / weight[k]).squaredNorm();
        if (d < best[k]) {
            best[k] = d;
            samples[k] = static_cast<std::uint32_t>(i);
        }
    }
}

/// The patch of each candidate. Where a sample has moved away, or has turned by moving, candidates may be left without
/// one that faces them: then some of them become samples too.
std::vector<std::uint32_t> assignPatches(const Candidates& all, double radius, std::vector<std::uint32_t>& samples) {
    std::vector<std::uint32_t> patch = assignNearest(all.positions, all.normals, radius, samples);
    std::vector<std::uint32_t> left;
    for (std::uint32_t i = 0; i < patch.size(); ++i)
        if (patch[i] == kNoPoint) left.push_back(i);
    if (left.empty()) return patch;
    const auto added = diskSubset(all.positions, all.normals, radius, left);
    samples.insert(samples.end(), added.begin(), added.end());
    return assignNearest(all.positions, all.normals, radius, samples);
}

void appendPatches(const Candidates& all, const std::vector<std::uint32_t>& patch,
                   const std::vector<std::uint32_t>& samples, PointShell& shell) {
    std::vector<Vec3> area_vector(samples.size(), Vec3::Zero());
    const std::size_t first = shell.points.size();
    for (const std::uint32_t s : samples) shell.points.push_back({all.positions[s], all.normals[s], 0.0});
    for (std::size_t i = 0; i < patch.size(); ++i) {
        SurfacePoint& point = shell.points[first + patch[i]];
        point.area += all.areas[i];
        area_vector[patch[i]] += all.areas[i] * all.normals[i];
        shell.total_area += all.areas[i];
        shell.cover_radius = std::max(shell.cover_radius, (all.positions[i] - point.position).norm() + all.reach);
    }
    for (std::size_t k = 0; k < samples.size(); ++k) shell.points[first + k].normal = area_vector[k].normalized();
}

/// Samples on sharp edges and boundaries, corners first so that they are kept.
void appendEdges(const TriangleMesh& mesh, double spacing, PointShell& shell) {
    std::map<std::array<std::uint32_t, 2>, std::vector<Vec3>> faces;  // normals at each edge
    for (const auto& t : mesh.triangles) {
        const Vec3 area = areaVector(mesh, t);
        if (!(area.norm() > 0.0)) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            faces[{std::min(a, b), std::max(a, b)}].push_back(area.normalized());
        }
    }
    std::vector<Vec3> positions, normals;
    std::map<std::uint32_t, std::vector<Vec3>> directions;  // of the sharp edges at a vertex
    const auto add = [&](const Vec3& p, const Vec3& n) {
        positions.push_back(p);
        normals.push_back(n.norm() > 1e-9 ? n.normalized() : n);
    };
    std::vector<std::array<std::uint32_t, 2>> sharp;
    std::map<std::uint32_t, Vec3> vertex_normal;
    for (const auto& [edge, normal] : faces) {
        if (normal.size() == 2 && normal[0].dot(normal[1]) > kSharpCosine) continue;
        sharp.push_back(edge);
        const Vec3 direction = (mesh.vertices[edge[1]] - mesh.vertices[edge[0]]).normalized();
        directions[edge[0]].push_back(direction);
        directions[edge[1]].push_back(-direction);
        for (const std::uint32_t v : edge) {
            Vec3& sum = vertex_normal.try_emplace(v, Vec3::Zero()).first->second;
            for (const Vec3& n : normal) sum += n;
        }
    }
    for (const auto& [v, d] : directions) {
        const bool passes_straight = d.size() == 2 && d[0].dot(d[1]) < -kSharpCosine;
        if (!passes_straight) add(mesh.vertices[v], vertex_normal[v]);
    }
    for (const auto& edge : sharp) {
        const Vec3 a = mesh.vertices[edge[0]], b = mesh.vertices[edge[1]];
        const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / (kEdgeShare * spacing))));
        Vec3 n = Vec3::Zero();
        for (const Vec3& face : faces[edge]) n += face;
        for (int i = 0; i < pieces; ++i) add(a + (b - a) * ((i + 0.5) / pieces), n);
    }
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    for (const std::uint32_t i : diskSubset(positions, normals, kDiskShare * kEdgeShare * spacing, order)) {
        shell.points.push_back({positions[i], normals[i], 0.0});
    }
}

}  // namespace

PointShell samplePoints(const TriangleMesh& mesh, double spacing) {
    PointShell shell;
    const Candidates all = cutMesh(mesh, kCandidateShare * spacing);
    std::vector<std::uint32_t> order(all.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    Random random(kSeed);
    shuffle(order, random);
    const double radius = kDiskShare * spacing;
    std::vector<std::uint32_t> samples = diskSubset(all.positions, all.normals, radius, order);
    std::vector<std::uint32_t> patch = assignPatches(all, radius, samples);
    for (int i = 0; i < kRelaxations; ++i) {
        relax(all, patch, samples);
        // A relaxed sample may have moved away from a candidate by up to a patch: search twice as far.
        patch = assignPatches(all, 2.0 * radius, samples);
    }
    appendPatches(all, patch, samples, shell);
    appendEdges(mesh, spacing, shell);
    return shell;
}

}  // namespace passung::model
