#include "core/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace passung::geometry {

namespace {

constexpr double kCubeRounding = 1e-12;  // of lengths and coordinates around a cube

double squaredToBox(const Vec3& p, const Vec3& low, const Vec3& high) {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

/// Rounding spoils the regions of a triangle that is much longer than high: the weights err by ε (distance/height)².
/// What they name is still a point of the triangle, so the nearest of it and of the edges' is taken; either errs by
/// less than height²/distance. Without area the regions may name no number, which no comparison prefers.
Vec3 closestOnNeedle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 best = closestOnSegment(p, a, b);
    for (const Vec3& q : {closestOnSegment(p, b, c), closestOnSegment(p, c, a), closestOnTriangle(p, a, b, c)})
        if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    return best;
}

Vec3 closestPoint(const TriangleTree::Corners& t, const Vec3& p) {
    return t.needle ? closestOnNeedle(p, t.a, t.b, t.c) : closestOnTriangle(p, t.a, t.b, t.c);
}

/// Sum of half solid angles of triangles seen from one point, positive from behind their front faces
/// (A. Van Oosterom, J. Strackee 1983). With a, b, c the corners relative to the point and a, b, c their lengths,
///   tan(Ω/2) = a·(b×c) / (abc + (a·b)c + (b·c)a + (c·a)b) = y/x,
/// so Ω/2 is the angle of the complex number x + iy, and a sum of angles is the angle of a product. Two numbers in the
/// upper half plane whose product leaves it have passed half a turn (and likewise below): that is counted apart, and
/// one arc tangent serves a whole leaf.
class HalfAngleSum {
public:
    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        const double x = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        const double y = a.dot(b.cross(c));
        if (y == 0.0 && x >= 0.0) return;  // seen edge-on, or without area
        const double next_x = x_ * x - y_ * y, next_y = x_ * y + y_ * x;
        if (y_ >= 0.0 && y >= 0.0 && next_y < 0.0) ++turns_;
        if (y_ < 0.0 && y < 0.0 && next_y >= 0.0) --turns_;
        x_ = next_x;
        y_ = next_y;
    }
    double value() const { return std::atan2(y_, x_) + 2.0 * std::numbers::pi * turns_; }

private:
    double x_ = 1.0, y_ = 0.0;
    int turns_ = 0;
};

}  // namespace

ClosestPoint TriangleTree::closest(const Vec3& p, double limit) const {
    struct Entry {
        std::uint32_t node;
        double squared;
    };
    std::array<Entry, kStack> stack;
    int size = 0;
    double best = limit * limit;
    Vec3 way = Vec3::Zero();
    ClosestPoint result{limit, p, 0, 0};
    bool found = false;
    stack[static_cast<std::size_t>(size++)] = {0, squaredToBox(p, nodes_[0].low, nodes_[0].high)};
    while (size > 0) {
        const Entry entry = stack[static_cast<std::size_t>(--size)];
        if (entry.squared >= best) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            const Node &left = nodes_[node.first], &right = nodes_[node.first + 1];
            Entry near{node.first, squaredToBox(p, left.low, left.high)};
            Entry far{node.first + 1, squaredToBox(p, right.low, right.high)};
            if (far.squared < near.squared) std::swap(near, far);
            if (far.squared < best) stack[static_cast<std::size_t>(size++)] = far;
            if (near.squared < best) stack[static_cast<std::size_t>(size++)] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            // A triangle beyond the plane through the best point, across the way to it, is no nearer.
            const Corners& t = corners_[i];
            if (std::min({t.a.dot(way), t.b.dot(way), t.c.dot(way)}) - p.dot(way) >= best) continue;
            const Vec3 q = closestPoint(t, p);
            const double squared = (q - p).squaredNorm();
            if (squared < best) {
                best = squared;
                way = q - p;
                result.point = q;
                result.triangle = original_[i];
                result.place = i;
                found = true;
            }
        }
    }
    if (found) result.distance = std::sqrt(best);
    return result;
}

static bool meet(const Bounds& box, const Vec3& low, const Vec3& high) {
    return (low.array() <= box.high.array()).all() && (high.array() >= box.low.array()).all();
}

static bool meets(const Bounds& box, const TriangleTree::Corners& t) {
    return meet(box, t.a.cwiseMin(t.b).cwiseMin(t.c), t.a.cwiseMax(t.b).cwiseMax(t.c));
}

/// Looks into the nodes that `enters` lets through, and gives the triangles of their leaves to `visit`, in tree order.
template <class Enters, class Visit>
void TriangleTree::walk(Enters enters, Visit visit) const {
    std::array<std::uint32_t, kStack> stack;
    int size = 0;
    stack[static_cast<std::size_t>(size++)] = 0;
    while (size > 0) {
        const Node& node = nodes_[stack[static_cast<std::size_t>(--size)]];
        if (!enters(node)) continue;
        if (node.count == 0) {
            stack[static_cast<std::size_t>(size++)] = node.first + 1;
            stack[static_cast<std::size_t>(size++)] = node.first;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(i);
    }
}

void TriangleTree::findNear(const Vec3& p, double radius, std::vector<std::uint32_t>& found) const {
    walk([&](const Node& node) { return squaredToBox(p, node.low, node.high) <= radius * radius; },
         [&](std::uint32_t i) { found.push_back(i); });
}

void TriangleTree::findAbove(const Bounds& box, const Vec3& way, double least,
                             std::vector<std::uint32_t>& found) const {
    const Vec3 half_way = 0.5 * way, half_reach = half_way.cwiseAbs();
    walk(
        [&](const Node& node) {
            return meet(box, node.low, node.high) &&
                   half_way.dot(node.low + node.high) + half_reach.dot(node.high - node.low) >= least;
        },
        [&](std::uint32_t i) {
            const Corners& t = corners_[i];
            if (std::max({way.dot(t.a), way.dot(t.b), way.dot(t.c)}) >= least && meets(box, t)) found.push_back(i);
        });
}

/// Above is the distance u from the triangle nearest to the centre c, convex, hence nowhere above its values at the
/// corners interpolated; below is the support s of the distance from a box at c, linear. Where s > u at all corners the
/// triangles of the box are nowhere nearest.
void TriangleTree::findNearest(const Vec3& centre, double half, std::vector<std::uint32_t>& found) const {
    const ClosestPoint closest_point = closest(centre);
    const double rounding = kCubeRounding * (closest_point.distance + half + centre.cwiseAbs().maxCoeff());
    std::array<double, 8> above;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 corner = centre + half * Vec3(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
        above[i] = (closestPoint(corners_[closest_point.place], corner) - corner).norm() + rounding;
    }
    walk(
        [&](const Node& node) {
            const Vec3 way = centre - centre.cwiseMax(node.low).cwiseMin(node.high);
            const double d = way.norm();
            const Vec3 turn = d > 0.0 ? Vec3((half / d) * way) : Vec3(Vec3::Zero());
            bool near = false;
            for (std::size_t i = 0; i < 8; ++i)
                near |= d + ((i & 1 ? turn.x() : -turn.x()) + (i & 2 ? turn.y() : -turn.y()) +
                             (i & 4 ? turn.z() : -turn.z())) <=
                        above[i];
            return near;
        },
        [&](std::uint32_t i) { found.push_back(i); });
}

TrianglePair TriangleTree::closestTo(const TriangleCorners& triangle, double limit) const {
    struct Entry {
        std::uint32_t node;
        double squared;
    };
    Bounds box;
    for (const Vec3& corner : triangle) box.extend(corner);
    const auto apart = [&](const Node& node) {
        return (box.low - node.high).cwiseMax(node.low - box.high).cwiseMax(0.0).squaredNorm();
    };
    std::array<Entry, kStack> stack;
    int size = 0;
    TrianglePair best{limit, triangle[0], triangle[0]};
    double squared = limit * limit;
    stack[static_cast<std::size_t>(size++)] = {0, apart(nodes_[0])};
    while (size > 0) {
        const Entry entry = stack[static_cast<std::size_t>(--size)];
        if (entry.squared >= squared) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            Entry near{node.first, apart(nodes_[node.first])};
            Entry far{node.first + 1, apart(nodes_[node.first + 1])};
            if (far.squared < near.squared) std::swap(near, far);
            if (far.squared < squared) stack[static_cast<std::size_t>(size++)] = far;
            if (near.squared < squared) stack[static_cast<std::size_t>(size++)] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const TrianglePair pair =
                closestPair(triangle, {corners_[i].a, corners_[i].b, corners_[i].c}, best.distance);
            if (!(pair.distance < best.distance)) continue;
            best = pair;
            squared = pair.distance * pair.distance;
        }
    }
    return best;
}

double TriangleTree::windingNumber(const Vec3& p) const {
    std::array<std::uint32_t, kStack> stack;
    int size = 0;
    stack[static_cast<std::size_t>(size++)] = 0;
    double near_sum = 0.0;  // half solid angles
    double far_sum = 0.0;   // solid angles of dipoles
    while (size > 0) {
        const std::uint32_t index = stack[static_cast<std::size_t>(--size)];
        const Cluster& cluster = clusters_[index];
        const Vec3 to_centre = cluster.centre - p;
        const double squared = to_centre.squaredNorm();
        if (squared > cluster.far_squared) {
            far_sum += to_centre.dot(cluster.dipole) / (squared * std::sqrt(squared));
            continue;
        }
        const Node& node = nodes_[index];
        if (node.count == 0) {
            stack[static_cast<std::size_t>(size++)] = node.first + 1;
            stack[static_cast<std::size_t>(size++)] = node.first;
            continue;
        }
        HalfAngleSum leaf;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            leaf.add(corners_[i].a - p, corners_[i].b - p, corners_[i].c - p);
        near_sum += leaf.value();
    }
    return (2.0 * near_sum + far_sum) / (4.0 * std::numbers::pi);
}

}  // namespace passung::geometry
