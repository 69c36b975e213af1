#include "analysis/truth/triangle_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace passung::truth {
namespace {

constexpr std::uint32_t kLeaf = 4, kMostListed = 4096;
constexpr std::size_t kDeepest = 80;  // the tree halves its triangles
constexpr double kFar = 3.0;          // radii of a cluster

Vec3 centroidOf(const Corners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

/// Six times the volume of the tetrahedron.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

/// Does the open segment from p to q pass through the open triangle?
bool passes(const Vec3& p, const Vec3& q, const Corners& t) {
    const double at_p = volume(t[0], t[1], t[2], p), at_q = volume(t[0], t[1], t[2], q);
    if (!((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))) return false;
    const double u = volume(p, q, t[0], t[1]), v = volume(p, q, t[1], t[2]), w = volume(p, q, t[2], t[0]);
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

bool boxesMeet(const geometry::Bounds& a, const geometry::Bounds& b) {
    return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

double distanceToBox(const Vec3& p, const geometry::Bounds& box) {
    return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).norm();
}

/// Solid angle of a triangle seen from p (van Oosterom and Strackee 1983), of its back < 0.
double solidAngle(const Corners& t, const Vec3& p) {
    const Vec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

bool triangleMeets(const Corners& a, const Corners& b) {
    for (std::size_t i = 0; i < 3; ++i)
        if (passes(a[i], a[(i + 1) % 3], b) || passes(b[i], b[(i + 1) % 3], a)) return true;
    return false;
}

TriangleBoxes::TriangleBoxes(const geometry::TriangleMesh& mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (const geometry::Triangle& t : mesh.triangles)
        triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    nodes_.reserve(triangles_.size());
    grow(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::uint32_t TriangleBoxes::grow(std::uint32_t first, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    node.first = first;
    node.end = end;
    geometry::Bounds middles;
    double area = 0.0;
    for (std::uint32_t i = first; i < end; ++i) {
        const Corners& t = triangles_[i];
        for (const Vec3& corner : t) node.box.extend(corner);
        middles.extend(centroidOf(t));
        const Vec3 normal = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
        node.dipole += normal;
        node.centre += normal.norm() * centroidOf(t);
        area += normal.norm();
    }
    node.centre = area > 0.0 ? Vec3(node.centre / area) : centroidOf(triangles_[first]);
    const double radius =
        (node.centre - node.box.low).cwiseAbs().cwiseMax((node.box.high - node.centre).cwiseAbs()).norm();
    node.far_squared = kFar * kFar * radius * radius;
    enclose(node);
    listVertices(node);
    nodes_.push_back(node);
    if (end - first <= kLeaf) return index;
    Eigen::Index axis = 0;
    middles.size().maxCoeff(&axis);
    const std::uint32_t middle = first + (end - first) / 2;
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + end,
                     [&](const Corners& a, const Corners& b) { return centroidOf(a)[axis] < centroidOf(b)[axis]; });
    grow(first, middle);
    const std::uint32_t right = grow(middle, end);
    nodes_[index].right = right;
    return index;
}

void TriangleBoxes::listVertices(Node& node) {
    if (node.end - node.first > kMostListed) return;
    std::vector<std::array<double, 3>> found;
    for (std::uint32_t i = node.first; i < node.end; ++i)
        for (const Vec3& corner : triangles_[i]) found.push_back({corner.x(), corner.y(), corner.z()});
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    node.first_vertex = static_cast<std::uint32_t>(vertices_.size());
    node.vertices = static_cast<std::uint32_t>(found.size());
    for (const auto& p : found) vertices_.emplace_back(p[0], p[1], p[2]);
}

/// One axis along the mean normal, one along the greatest spread across it: the box of a sector of a mantle is as flat
/// as the sector. Where that is no smaller, or there is no normal, the box along the axes.
void TriangleBoxes::enclose(Node& node) const {
    const auto boxAlong = [&](const Mat3& axes) {  // columns
        geometry::Bounds bounds;
        for (std::uint32_t i = node.first; i < node.end; ++i)
            for (const Vec3& corner : triangles_[i]) bounds.extend(axes.transpose() * corner);
        for (unsigned k = 0; k < 8; ++k)
            node.hull[k] = axes * Vec3((k & 1u) != 0 ? bounds.high.x() : bounds.low.x(),
                                       (k & 2u) != 0 ? bounds.high.y() : bounds.low.y(),
                                       (k & 4u) != 0 ? bounds.high.z() : bounds.low.z());
    };
    const double size = node.box.size().norm();
    if (!(node.dipole.norm() > 1e-6 * size * size)) return boxAlong(Mat3::Identity());
    const Vec3 n = node.dipole.normalized();
    const Mat3 across = Mat3::Identity() - n * n.transpose();
    Mat3 spread = Mat3::Zero();
    for (std::uint32_t i = node.first; i < node.end; ++i)
        for (const Vec3& corner : triangles_[i]) {
            const Vec3 way = across * (corner - node.centre);
            spread += way * way.transpose();
        }
    Vec3 longest = across * Vec3(0.6, 0.5, 0.62);  // turned towards the greatest spread by powers of it
    for (int i = 0; i < 30 && spread.norm() > 0.0; ++i) longest = (spread * longest).normalized();
    longest = across * longest;
    if (!(longest.norm() > 0.5)) return boxAlong(Mat3::Identity());
    longest.normalize();
    Mat3 axes;
    axes << longest, n.cross(longest), n;
    boxAlong(axes);
}

TriangleBoxes::Nearest TriangleBoxes::nearest(const Vec3& p) const {
    struct Waiting {
        double distance;
        std::uint32_t node;
    };
    const auto waitingAt = [&](std::uint32_t node) { return Waiting{distanceToBox(p, nodes_[node].box), node}; };
    Nearest best{std::numeric_limits<double>::infinity(), 0};
    std::array<Waiting, kDeepest> waiting;
    std::size_t count = 0;
    waiting[count++] = waitingAt(0);
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.distance >= best.distance) continue;
        const Node& node = nodes_[next.node];
        if (node.right != 0) {
            Waiting a = waitingAt(next.node + 1), b = waitingAt(node.right);
            if (a.distance < b.distance) std::swap(a, b);
            waiting[count++] = a;
            waiting[count++] = b;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.end; ++i)
            if (const double d = distanceToTriangle(p, triangles_[i]); d < best.distance) best = {d, i};
    }
    return best;
}

bool TriangleBoxes::isMetBy(const Corners& t) const {
    geometry::Bounds box;
    for (const Vec3& corner : t) box.extend(corner);
    std::array<std::uint32_t, kDeepest> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const std::uint32_t index = waiting[--count];
        const Node& node = nodes_[index];
        if (!boxesMeet(box, node.box)) continue;
        if (node.right != 0) {
            waiting[count++] = node.right;
            waiting[count++] = index + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.end; ++i)
            if (triangleMeets(t, triangles_[i])) return true;
    }
    return false;
}

double TriangleBoxes::windingNumber(const Vec3& p) const {
    double angle = 0.0;
    std::array<std::uint32_t, kDeepest> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    while (count > 0) {
        const std::uint32_t index = waiting[--count];
        const Node& node = nodes_[index];
        const Vec3 way = node.centre - p;
        const double squared = way.squaredNorm();
        if (squared > node.far_squared) {
            angle += node.dipole.dot(way) / (squared * std::sqrt(squared));
        } else if (node.right != 0) {
            waiting[count++] = node.right;
            waiting[count++] = index + 1;
        } else {
            for (std::uint32_t i = node.first; i < node.end; ++i) angle += solidAngle(triangles_[i], p);
        }
    }
    return angle / (4.0 * std::numbers::pi);
}

}  // namespace passung::truth
