#include "analysis/truth/exact_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "core/base/random.h"

namespace passung::truth {
namespace {

constexpr int kRayDirections = 5;
constexpr std::uint32_t kExactLeafTriangles = 4;
constexpr std::size_t kDeepest = 64;  // the tree halves its triangles: no branch is longer

double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    return (a + t * ab - p).norm();
}

Vec3 normalOf(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// Twice the signed area of (a, b, p) in x, y. Exactly antisymmetric in a and b, so that two triangles never
/// disagree about the side of their shared edge on which p lies.
double side(const Vec3& a, const Vec3& b, double px, double py) {
    const bool swapped = std::pair(b.x(), b.y()) < std::pair(a.x(), a.y());
    const Vec3& from = swapped ? b : a;
    const Vec3& to = swapped ? a : b;
    const double value = (to.x() - from.x()) * (py - from.y()) - (to.y() - from.y()) * (px - from.x());
    return swapped ? -value : value;
}

/// Does the ray from `p` along +z cross `t`?
bool crosses(const Corners& t, const Vec3& p) {
    const double w0 = side(t[1], t[2], p.x(), p.y());
    const double w1 = side(t[2], t[0], p.x(), p.y());
    const double w2 = side(t[0], t[1], p.x(), p.y());
    const bool in_front = w0 > 0.0 && w1 > 0.0 && w2 > 0.0;
    const bool from_behind = w0 < 0.0 && w1 < 0.0 && w2 < 0.0;
    if (!in_front && !from_behind) return false;
    return (w0 * t[0].z() + w1 * t[1].z() + w2 * t[2].z()) / (w0 + w1 + w2) > p.z();
}

int binOf(double value, double low, double inverse_size, int count) {
    return std::clamp(static_cast<int>(std::floor((value - low) * inverse_size)), 0, count - 1);
}

/// Distance of `p` from the box, less what rounding may add: a triangle in it is never nearer.
double distanceToBox(const Vec3& p, const geometry::Bounds& box) {
    constexpr double kLess = 1.0 - 1e-12;
    return kLess * (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).norm();
}

/// Lists of triangles per cell, all in one array: `visit(i, mark)` calls mark(cell) for every cell of triangle i.
template <class Visit>
void fillCells(std::size_t cells, std::size_t triangles, const Visit& visit, std::vector<std::uint32_t>& start,
               std::vector<std::uint32_t>& list) {
    start.assign(cells + 1, 0);
    for (std::size_t i = 0; i < triangles; ++i) visit(i, [&](std::size_t cell) { ++start[cell + 1]; });
    for (std::size_t c = 0; c < cells; ++c) start[c + 1] += start[c];
    list.resize(start[cells]);
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < triangles; ++i) {
        visit(i, [&](std::size_t cell) { list[next[cell]++] = static_cast<std::uint32_t>(i); });
    }
}

}  // namespace

double distanceToTriangle(const Vec3& p, const Corners& t) {
    const Vec3 n = normalOf(t);
    const double n2 = n.squaredNorm();
    if (n2 > 0.0) {
        // Inside the prism over the triangle the plane is nearest, everywhere else an edge.
        const bool above = (t[1] - t[0]).cross(p - t[0]).dot(n) >= 0.0 && (t[2] - t[1]).cross(p - t[1]).dot(n) >= 0.0 &&
                           (t[0] - t[2]).cross(p - t[2]).dot(n) >= 0.0;
        if (above) return std::abs((p - t[0]).dot(n)) / std::sqrt(n2);
    }
    return std::min(
        {distanceToSegment(p, t[0], t[1]), distanceToSegment(p, t[1], t[2]), distanceToSegment(p, t[2], t[0])});
}

ExactMesh::ExactMesh(const geometry::TriangleMesh& mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (const geometry::Triangle& t : mesh.triangles) {
        triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
        for (const Vec3& corner : triangles_.back()) bounds_.extend(corner);
    }
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    grow(0, static_cast<std::uint32_t>(triangles_.size()));
    for (const std::uint32_t i : order_) sorted_.push_back(triangles_[i]);
    Random random(20260);
    for (int i = 0; i < kRayDirections; ++i) {
        const Quat turn(random.normal(), random.normal(), random.normal(), random.normal());
        views_.push_back(buildView(turn.normalized().toRotationMatrix()));
    }
}

// ---- closest triangle ----

std::uint32_t ExactMesh::grow(std::uint32_t first, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    geometry::Bounds box, middles;
    const auto middleOf = [&](std::uint32_t i) { return Vec3(triangles_[i][0] + triangles_[i][1] + triangles_[i][2]); };
    for (std::uint32_t k = first; k < end; ++k) {
        for (const Vec3& corner : triangles_[order_[k]]) box.extend(corner);
        middles.extend(middleOf(order_[k]));
    }
    nodes_.push_back({box, first, end});
    if (end - first <= kExactLeafTriangles) return index;
    Eigen::Index axis = 0;
    middles.size().maxCoeff(&axis);
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return middleOf(a)[axis] < middleOf(b)[axis]; });
    grow(first, middle);
    const std::uint32_t right = grow(middle, end);
    nodes_[index].right = right;
    return index;
}

ExactMesh::Nearest ExactMesh::nearest(const Vec3& p) const {
    Nearest best{std::numeric_limits<double>::infinity(), 0};
    struct Waiting {
        double distance;  // of the box, a little less
        std::uint32_t node;
    };
    const auto waitingAt = [&](std::uint32_t node) { return Waiting{distanceToBox(p, nodes_[node].box), node}; };
    std::array<Waiting, kDeepest> waiting;
    std::size_t count = 0;
    waiting[count++] = waitingAt(0);
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.distance >= best.distance) continue;
        const Node& node = nodes_[next.node];
        if (node.right != 0) {
            Waiting near = waitingAt(next.node + 1), far = waitingAt(node.right);
            if (far.distance < near.distance) std::swap(near, far);
            waiting[count++] = far;
            waiting[count++] = near;
            continue;
        }
        for (std::uint32_t k = node.first; k < node.end; ++k) {
            const double distance = distanceToTriangle(p, sorted_[k]);
            if (distance < best.distance) best = {distance, order_[k]};
        }
    }
    return best;
}

void ExactMesh::collectAround(const Vec3& p, double radius, std::vector<std::uint32_t>& triangles) const {
    std::array<std::uint32_t, kDeepest> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const std::uint32_t index = waiting[--count];
        const Node& node = nodes_[index];
        if (distanceToBox(p, node.box) > radius) continue;
        if (node.right != 0) {
            waiting[count++] = index + 1;
            waiting[count++] = node.right;
        } else {
            triangles.insert(triangles.end(), order_.begin() + node.first, order_.begin() + node.end);
        }
    }
}

// ---- inside ----

ExactMesh::RayView ExactMesh::buildView(const Mat3& turn) const {
    RayView view;
    view.turn = turn;
    geometry::Bounds box;
    for (const Corners& t : triangles_) {
        view.corners.push_back({turn * t[0], turn * t[1], turn * t[2]});
        for (const Vec3& corner : view.corners.back()) box.extend(corner);
    }
    const int bins = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))), 1, 512);
    const Vec3 size = box.size().cwiseMax(1e-9);
    view.low_x = box.low.x();
    view.low_y = box.low.y();
    view.inverse_bin_x = bins / size.x();
    view.inverse_bin_y = bins / size.y();
    const auto visit = [&](std::size_t i, const auto& mark) {
        geometry::Bounds shadow;
        for (const Vec3& corner : view.corners[i]) shadow.extend(corner);
        // binOf is monotonic: a point in the triangle's shadow is in one of these bins, rounding or not.
        const int x_end = binOf(shadow.high.x(), view.low_x, view.inverse_bin_x, bins);
        const int y_end = binOf(shadow.high.y(), view.low_y, view.inverse_bin_y, bins);
        for (int y = binOf(shadow.low.y(), view.low_y, view.inverse_bin_y, bins); y <= y_end; ++y) {
            for (int x = binOf(shadow.low.x(), view.low_x, view.inverse_bin_x, bins); x <= x_end; ++x) {
                mark(static_cast<std::size_t>(y) * static_cast<std::size_t>(bins) + static_cast<std::size_t>(x));
            }
        }
    };
    fillCells(static_cast<std::size_t>(bins) * static_cast<std::size_t>(bins), triangles_.size(), visit, view.bin_start,
              view.bin_triangles);
    view.bins = bins;
    return view;
}

bool ExactMesh::RayView::odd(const Vec3& p_mesh) const {
    const Vec3 p = turn * p_mesh;
    const auto bin =
        static_cast<std::size_t>(binOf(p.y(), low_y, inverse_bin_y, bins)) * static_cast<std::size_t>(bins) +
        static_cast<std::size_t>(binOf(p.x(), low_x, inverse_bin_x, bins));
    bool result = false;
    for (std::uint32_t i = bin_start[bin]; i < bin_start[bin + 1]; ++i) {
        if (crosses(corners[bin_triangles[i]], p)) result = !result;
    }
    return result;
}

bool ExactMesh::contains(const Vec3& p) const {
    if ((p.array() < bounds_.low.array()).any() || (p.array() > bounds_.high.array()).any()) return false;
    const auto votes = std::count_if(views_.begin(), views_.end(), [&](const RayView& view) { return view.odd(p); });
    return 2 * votes > kRayDirections;
}

double ExactMesh::signedDistance(const Vec3& p) const {
    const double distance = nearest(p).distance;
    return contains(p) ? -distance : distance;
}

// ---- depth ----

namespace {

/// A part of a surface triangle, in the solid's frame. No point of it is deeper than `bound`.
struct Piece {
    double bound;
    Corners corners;
    bool operator<(const Piece& other) const { return bound < other.bound; }
};

/// True only if an axis parts the two triangles: a normal, or the cross product of two edges.
bool areApart(const Corners& a, const Corners& b) {
    const auto parts = [&](const Vec3& axis) {
        const double a0 = axis.dot(a[0]), a1 = axis.dot(a[1]), a2 = axis.dot(a[2]);
        const double b0 = axis.dot(b[0]), b1 = axis.dot(b[1]), b2 = axis.dot(b[2]);
        return std::max({a0, a1, a2}) < std::min({b0, b1, b2}) || std::max({b0, b1, b2}) < std::min({a0, a1, a2});
    };
    if (parts(normalOf(b)) || parts(normalOf(a))) return true;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (parts((a[(i + 1) % 3] - a[i]).cross(b[(k + 1) % 3] - b[k]))) return true;
        }
    }
    return false;
}

std::array<Piece, 2> halved(const Piece& piece) {
    const Corners& c = piece.corners;
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i) {
        if ((c[(i + 1) % 3] - c[i]).squaredNorm() > (c[(longest + 1) % 3] - c[longest]).squaredNorm()) longest = i;
    }
    const Vec3& a = c[longest];
    const Vec3& b = c[(longest + 1) % 3];
    const Vec3& apex = c[(longest + 2) % 3];
    const Vec3 middle = 0.5 * (a + b);
    return {Piece{piece.bound, {a, middle, apex}}, Piece{piece.bound, {middle, b, apex}}};
}

}  // namespace

// Best first over pieces of the surface. For a piece T with centroid c and radius r about it, every x in T has
//   depth(x) ≤ depth(c) + r                        because the signed distance is 1-Lipschitz,
//   depth(x) ≤ max over the corners of dist(·, t)  for any one triangle t: that distance is convex, and depth is the
//                                                  smallest of them all (tight where two faces lie flat on each other),
//   depth(x) ≤ 0               if c is outside and T crosses no triangle within r of c: nor does the way from c to x.
DeepestPoint deepestPoint(const ExactMesh& solid, const ExactMesh& surface, const Pose& X_FS, double resolution,
                          std::size_t max_pieces) {
    std::priority_queue<Piece> pieces;
    const double unknown = std::numeric_limits<double>::infinity();
    for (const Corners& t : surface.triangles()) {
        const Corners corners{X_FS * t[0], X_FS * t[1], X_FS * t[2]};
        geometry::Bounds box;
        for (const Vec3& corner : corners) box.extend(corner);
        const bool away = (box.low.array() > solid.bounds().high.array()).any() ||
                          (box.high.array() < solid.bounds().low.array()).any();
        if (!away) pieces.push({unknown, corners});
    }

    DeepestPoint best;
    std::vector<std::uint32_t> around;
    const auto boundOf = [&](const Corners& corners) {
        const Vec3 c = (corners[0] + corners[1] + corners[2]) / 3.0;
        double radius = 0.0, to_nearest = 0.0;
        const ExactMesh::Nearest nearest = solid.nearest(c);
        for (const Vec3& corner : corners) {
            radius = std::max(radius, (corner - c).norm());
            to_nearest = std::max(to_nearest, distanceToTriangle(corner, solid.triangles()[nearest.triangle]));
        }
        const double depth = solid.contains(c) ? nearest.distance : -nearest.distance;
        if (depth > best.depth) {
            best.depth = depth;
            best.point = c;
        }
        const double bound = std::min(depth + radius, to_nearest);
        if (depth > 0.0 || bound <= best.depth + resolution) return bound;
        around.clear();
        solid.collectAround(c, radius, around);
        const bool crossed = std::any_of(around.begin(), around.end(), [&](std::uint32_t i) {
            const Corners& t = solid.triangles()[i];
            return !areApart(corners, t) && distanceToTriangle(c, t) <= radius;
        });
        return crossed ? bound : 0.0;
    };

    while (!pieces.empty() && best.pieces < max_pieces) {
        const Piece piece = pieces.top();
        if (piece.bound <= best.depth + resolution) break;
        pieces.pop();
        if (piece.bound == unknown) {
            pieces.push({boundOf(piece.corners), piece.corners});
            ++best.pieces;
            continue;
        }
        for (Piece& half : halved(piece)) {
            half.bound = std::min(half.bound, boundOf(half.corners));
            pieces.push(half);
            ++best.pieces;
        }
    }
    if (!pieces.empty()) best.uncertainty = std::max(0.0, pieces.top().bound - best.depth);
    return best;
}

}  // namespace passung::truth
