#include "tests/bench/surface_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

namespace passung::bench {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;

Vec3 middleOf(const truth::Corners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

double radiusOf(const truth::Corners& t, const Vec3& middle) {
    return std::max({(t[0] - middle).norm(), (t[1] - middle).norm(), (t[2] - middle).norm()});
}

/// Into four of the same shape.
std::array<truth::Corners, 4> cut(const truth::Corners& t) {
    const Vec3 a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
    return {truth::Corners{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}};
}

/// The integral over one triangle, cut as far as needed.
struct Integral {
    const truth::ExactMesh& solid;
    const Vec3& origin;
    double stiffness, longest_edge;
    Wrench wrench;

    void add(const truth::Corners& t) {
        const Vec3 middle = middleOf(t);
        const double radius = radiusOf(t, middle);
        const double phi = solid.signedDistance(middle);
        if (phi >= radius) return;
        const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
        if (longest > longest_edge) {
            for (const truth::Corners& piece : cut(t)) add(piece);
            return;
        }
        if (phi >= 0.0) return;
        const Vec3 area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
        const Vec3 force = stiffness * phi * area;  // -κ p n dA
        wrench.force += force;
        wrench.torque += (middle - origin).cross(force);
    }
};

}  // namespace

SurfaceTree::SurfaceTree(const truth::ExactMesh& surface) : triangles_(surface.triangles()) {
    grow(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t SurfaceTree::grow(std::uint32_t first, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    model::Bounds bounds;
    for (std::uint32_t i = first; i < end; ++i)
        for (const Vec3& corner : triangles_[i]) bounds.extend(corner);
    const Vec3 centre = 0.5 * (bounds.low + bounds.high);
    double radius = 0.0;
    for (std::uint32_t i = first; i < end; ++i)
        for (const Vec3& corner : triangles_[i]) radius = std::max(radius, (corner - centre).norm());
    nodes_.push_back({centre, radius, first, end});
    if (end - first <= kLeafTriangles) return index;
    Eigen::Index axis = 0;
    bounds.size().maxCoeff(&axis);
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + end,
                     [&](const auto& a, const auto& b) { return middleOf(a)[axis] < middleOf(b)[axis]; });
    grow(first, middle);
    const std::uint32_t right = grow(middle, end);
    nodes_[index].right = right;
    return index;
}

SmallestDistance SurfaceTree::smallestDistance(const truth::ExactMesh& solid, const Pose& X_FS,
                                               double resolution) const {
    struct Piece {
        double bound;  // no point of the piece has a smaller φ
        std::uint32_t node;
        truth::Corners triangle;  // if it is no node: in the solid's frame
    };
    constexpr std::uint32_t kNoNode = std::numeric_limits<std::uint32_t>::max();
    const auto later = [](const Piece& a, const Piece& b) { return a.bound > b.bound; };
    std::priority_queue<Piece, std::vector<Piece>, decltype(later)> waiting(later);
    double best = std::numeric_limits<double>::infinity();
    const auto addNode = [&](std::uint32_t index) {
        const Node& node = nodes_[index];
        const double bound = solid.signedDistance(X_FS * node.centre) - node.radius;
        if (bound < best) waiting.push({bound, index, {}});
    };
    const auto addTriangle = [&](const truth::Corners& t) {
        const Vec3 middle = middleOf(t);
        const truth::ExactMesh::Nearest nearest = solid.nearest(middle);
        const double phi = solid.contains(middle) ? -nearest.distance : nearest.distance;
        best = std::min(best, phi);
        // The distance from one triangle is convex: no point of the piece is farther from it, or deeper, than a corner.
        double deepest = 0.0;
        for (const Vec3& corner : t)
            deepest = std::max(deepest, truth::distanceToTriangle(corner, solid.triangles()[nearest.triangle]));
        const double bound = std::max(phi - radiusOf(t, middle), -deepest);
        if (bound < best) waiting.push({bound, kNoNode, t});
    };
    addNode(0);
    while (!waiting.empty() && waiting.top().bound < best - resolution) {
        const Piece piece = waiting.top();
        waiting.pop();
        if (piece.node == kNoNode) {
            for (const truth::Corners& part : cut(piece.triangle)) addTriangle(part);
        } else if (const Node& node = nodes_[piece.node]; node.right != 0) {
            addNode(piece.node + 1);
            addNode(node.right);
        } else {
            for (std::uint32_t i = node.first; i < node.end; ++i)
                addTriangle({X_FS * triangles_[i][0], X_FS * triangles_[i][1], X_FS * triangles_[i][2]});
        }
    }
    return {best, waiting.empty() ? 0.0 : std::max(0.0, best - waiting.top().bound)};
}

Wrench SurfaceTree::penaltyWrench(const truth::ExactMesh& solid, const Pose& X_FS, double area_stiffness,
                                  double longest_edge) const {
    Integral integral{solid, X_FS.p, area_stiffness, longest_edge, {}};
    std::vector<std::uint32_t> waiting{0};
    while (!waiting.empty()) {
        const std::uint32_t index = waiting.back();
        waiting.pop_back();
        const Node& node = nodes_[index];
        if (solid.signedDistance(X_FS * node.centre) >= node.radius) continue;
        if (node.right != 0) {
            waiting.push_back(index + 1);
            waiting.push_back(node.right);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.end; ++i)
            integral.add({X_FS * triangles_[i][0], X_FS * triangles_[i][1], X_FS * triangles_[i][2]});
    }
    return integral.wrench;
}

}  // namespace passung::bench
