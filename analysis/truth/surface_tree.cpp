#include "analysis/truth/surface_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

namespace passung::truth {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;

Vec3 middleOf(const Corners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

double radiusOf(const Corners& t, const Vec3& middle) {
    return std::max({(t[0] - middle).norm(), (t[1] - middle).norm(), (t[2] - middle).norm()});
}

double edge2(const Corners& t, std::size_t i) { return (t[(i + 1) % 3] - t[i]).squaredNorm(); }

std::size_t longestEdge(const Corners& t) {
    const std::size_t first = edge2(t, 1) > edge2(t, 0) ? 1 : 0;
    return edge2(t, 2) > edge2(t, first) ? 2 : first;
}

/// In half across the longest edge: long, thin triangles of a mantle become compact pieces.
std::array<Corners, 2> cut(const Corners& t) {
    const std::size_t i = longestEdge(t);
    const Vec3 &a = t[i], &b = t[(i + 1) % 3], &apex = t[(i + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    return {Corners{a, middle, apex}, {middle, b, apex}};
}

/// The integral over one triangle, cut as far as needed.
struct Integral {
    const Solid& solid;
    const Vec3& origin;
    double stiffness, longest_edge;
    Wrench wrench;

    void add(const Corners& t) {
        const Vec3 middle = middleOf(t);
        const double radius = radiusOf(t, middle);
        const double phi = solid.signedDistance(middle);
        if (phi >= radius) return;
        if (edge2(t, longestEdge(t)) > longest_edge * longest_edge) {
            for (const Corners& piece : cut(t)) add(piece);
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

double Solid::signedDistance(const Vec3& p) const {
    return shape != nullptr ? shape::signedDistance(*shape, p) : mesh.signedDistance(p);
}

SurfaceTree::SurfaceTree(const ExactMesh& surface) : triangles_(surface.triangles()) {
    grow(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t SurfaceTree::grow(std::uint32_t first, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    geometry::Bounds bounds;
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

SmallestDistance SurfaceTree::smallestDistance(const Solid& solid, const Pose& X_FS, double resolution,
                                               std::size_t max_pieces) const {
    struct Piece {
        double bound;  // no point of the piece has a smaller φ
        std::uint32_t node;
        std::uint32_t near;  // if it is no node: a triangle of the solid that is near it
        Corners triangle;    // in the solid's frame
    };
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const auto later = [](const Piece& a, const Piece& b) { return a.bound > b.bound; };
    std::priority_queue<Piece, std::vector<Piece>, decltype(later)> waiting(later);
    double best = std::numeric_limits<double>::infinity();
    const double slack = resolution + solid.chord_error;
    const auto addNode = [&](std::uint32_t index) {
        const Node& node = nodes_[index];
        const double bound = solid.signedDistance(X_FS * node.centre) - node.radius;
        if (bound < best) waiting.push({bound, index, kNone, {}});
    };
    const auto addTriangle = [&](const Corners& t, std::uint32_t near) {
        const Vec3 middle = middleOf(t);
        const double phi = solid.signedDistance(middle);
        best = std::min(best, phi);
        double bound = phi - radiusOf(t, middle);
        if (bound >= best) return;
        // The distance from one triangle is convex: no point of the piece is farther from it, or deeper, than a corner.
        const auto improve = [&] {
            const Corners& triangle = solid.mesh.triangles()[near];
            double deepest = 0.0;
            for (const Vec3& corner : t) deepest = std::max(deepest, distanceToTriangle(corner, triangle));
            bound = std::max(bound, -deepest - solid.chord_error);
        };
        // Any triangle will do, the nearest one does best: it is searched only if that of the larger piece does not do.
        if (phi < 0.0 && near != kNone) improve();
        if (phi < 0.0 && bound < best - slack) {
            near = solid.mesh.nearest(middle).triangle;
            improve();
        }
        if (bound < best) waiting.push({bound, kNone, near, t});
    };
    addNode(0);
    for (std::size_t pieces = 0; pieces < max_pieces && !waiting.empty() && waiting.top().bound < best - slack;
         ++pieces) {
        const Piece piece = waiting.top();
        waiting.pop();
        if (piece.node == kNone) {
            for (const Corners& part : cut(piece.triangle)) addTriangle(part, piece.near);
        } else if (const Node& node = nodes_[piece.node]; node.right != 0) {
            addNode(piece.node + 1);
            addNode(node.right);
        } else {
            for (std::uint32_t i = node.first; i < node.end; ++i)
                addTriangle({X_FS * triangles_[i][0], X_FS * triangles_[i][1], X_FS * triangles_[i][2]}, kNone);
        }
    }
    return {best, waiting.empty() ? 0.0 : std::max(0.0, best - waiting.top().bound)};
}

Wrench SurfaceTree::penaltyWrench(const Solid& solid, const Pose& X_FS, double area_stiffness,
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

}  // namespace passung::truth
