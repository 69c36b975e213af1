#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "tests/support/brute_force_mesh.h"

/// Whether and how near two sets of triangles come to each other at a pose, triangle by triangle, by formulas of its
/// own: a truth for tests. No closedness, orientation or inside is asked for.
namespace passung::test {

using Corners3 = std::array<Vec3, 3>;

inline constexpr double kTouching = 1e-12;  // [m]: triangles nearer than this count as crossing

/// Six times the volume of a tetrahedron; the signs decide, so that it is computed in 64 bits of mantissa.
inline long double volumeOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    using Long = Eigen::Matrix<long double, 3, 1>;
    const Long o = a.cast<long double>();
    return (b.cast<long double>() - o).cross(c.cast<long double>() - o).dot(d.cast<long double>() - o);
}

/// True if the segment passes through the triangle's plane within the triangle; in doubt about the triangle's sides
/// true. One that lies in the plane, within 1e-14 m or so, does not: how near it is to points and edges then tells.
inline bool passesThrough(const Vec3& p, const Vec3& q, const Corners3& t) {
    const double longest = std::max({(q - p).norm(), (t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (p - t[0]).norm()});
    const long double doubt = std::ldexp(static_cast<long double>(longest) * longest * longest, -56);
    const long double from = volumeOf(t[0], t[1], t[2], p), to = volumeOf(t[0], t[1], t[2], q);
    if ((from > doubt && to > doubt) || (from < -doubt && to < -doubt)) return false;
    std::array<long double, 3> turn;
    for (std::size_t i = 0; i < 3; ++i) turn[i] = volumeOf(p, q, t[i], t[(i + 1) % 3]);
    const auto [least, most] = std::minmax_element(turn.begin(), turn.end());
    if (std::abs(from) <= doubt && std::abs(to) <= doubt) return false;  // in its plane: their edges tell
    return *least >= -doubt || *most <= doubt;
}

inline double distanceOfSegments(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const double ends = std::min({distanceToSegment<double>(p, r, s), distanceToSegment<double>(q, r, s),
                                  distanceToSegment<double>(r, p, q), distanceToSegment<double>(s, p, q)});
    const Vec3 d = q - p, e = s - r, across = d.cross(e);
    const double square = across.squaredNorm();
    if (!(square > 1e-24 * d.squaredNorm() * e.squaredNorm())) return ends;
    const double at = (r - p).cross(e).dot(across) / square, on = (r - p).cross(d).dot(across) / square;
    if (at < 0.0 || at > 1.0 || on < 0.0 || on > 1.0) return ends;
    return std::min(ends, (p + at * d - r - on * e).norm());
}

/// True if the plane of `plane` has all corners of `t` on one side, farther away than `limit`; rounding is less than a
/// millionth of that.
inline bool liesBeyond(const Corners3& t, const Corners3& plane, double limit) {
    const Vec3 normal = (plane[1] - plane[0]).cross(plane[2] - plane[0]);
    const double far = limit * normal.norm() * (1.0 + 1e-6);
    const Vec3 side(normal.dot(t[0] - plane[0]), normal.dot(t[1] - plane[0]), normal.dot(t[2] - plane[0]));
    return far > 0.0 && (side.minCoeff() > far || side.maxCoeff() < -far);
}

/// True if a direction across an edge of each shows that they are farther apart than `limit`; rounding as above.
inline bool liesAside(const Corners3& a, const Corners3& b, double limit) {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 axis = (a[(i + 1) % 3] - a[i]).cross(b[(j + 1) % 3] - b[j]);
            const double far = limit * axis.norm() * (1.0 + 1e-6);
            const Vec3 first(axis.dot(a[0] - b[0]), axis.dot(a[1] - b[0]), axis.dot(a[2] - b[0]));
            const Vec3 second(0.0, axis.dot(b[1] - b[0]), axis.dot(b[2] - b[0]));
            const double apart = std::max(first.minCoeff() - second.maxCoeff(), second.minCoeff() - first.maxCoeff());
            if (far > 0.0 && apart > far) return true;
        }
    return false;
}

/// 0 if they meet.
inline double distanceOfTriangles(const Corners3& a, const Corners3& b) {
    double least = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (passesThrough(a[i], a[next], b) || passesThrough(b[i], b[next], a)) return 0.0;
        least =
            std::min({least, distanceToTriangle(a[i], b[0], b[1], b[2]), distanceToTriangle(b[i], a[0], a[1], a[2])});
        for (std::size_t j = 0; j < 3; ++j)
            least = std::min(least, distanceOfSegments(a[i], a[next], b[j], b[(j + 1) % 3]));
    }
    return least <= kTouching ? 0.0 : least;
}

/// Boxes around the triangles of a mesh whose vertices may be moved.
class BoxTree {
public:
    explicit BoxTree(const geometry::TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        split(0, order_.size());
        move({});
    }

    void move(const Pose& X) {
        moved_.resize(mesh_.vertices.size());
        const Mat3 R = X.q.toRotationMatrix();
        for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = R * mesh_.vertices[i] + X.p;
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            Node& node = nodes_[i];
            node.box = {};
            if (node.right != 0) {
                node.box.extend(nodes_[i + 1].box.low);
                node.box.extend(nodes_[i + 1].box.high);
                node.box.extend(nodes_[node.right].box.low);
                node.box.extend(nodes_[node.right].box.high);
                continue;
            }
            for (std::size_t k = node.first; k < node.end; ++k)
                for (const Vec3& corner : cornersOf(k)) node.box.extend(corner);
        }
    }

    Corners3 cornersOf(std::size_t place) const {
        const auto& t = mesh_.triangles[order_[place]];
        return {moved_[t[0]], moved_[t[1]], moved_[t[2]]};
    }

    struct Node {
        geometry::Bounds box;
        std::size_t first = 0, end = 0, right = 0;  // left child: the next one; right 0: a leaf
    };
    const std::vector<Node>& nodes() const { return nodes_; }

private:
    void split(std::size_t first, std::size_t end) {
        const std::size_t self = nodes_.size();
        nodes_.push_back({{}, first, end, 0});
        if (end - first <= 2) return;
        geometry::Bounds centres;
        const auto centre = [this](std::uint32_t i) -> Vec3 {
            const auto& t = mesh_.triangles[i];
            return mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]];
        };
        for (std::size_t k = first; k < end; ++k) centres.extend(centre(order_[k]));
        Eigen::Index axis;
        centres.size().maxCoeff(&axis);
        const std::size_t middle = (first + end) / 2;
        std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(first),
                         order_.begin() + static_cast<std::ptrdiff_t>(middle),
                         order_.begin() + static_cast<std::ptrdiff_t>(end),
                         [&](std::uint32_t i, std::uint32_t j) { return centre(i)[axis] < centre(j)[axis]; });
        split(first, middle);
        nodes_[self].right = nodes_.size();
        split(middle, end);
    }

    geometry::TriangleMesh mesh_;
    std::vector<std::uint32_t> order_;
    std::vector<Vec3> moved_;
    std::vector<Node> nodes_;
};

class MeshPairTruth {
public:
    /// The first is moved.
    MeshPairTruth(const geometry::TriangleMesh& moving, const geometry::TriangleMesh& fixed)
        : moving_(moving), fixed_(fixed) {}

    /// Least distance of their triangles with the first at `X`, `limit` if it is not less; 0: they cross or touch.
    double distance(const Pose& X, double limit) {
        moving_.move(X);
        best_ = limit;
        visit(0, 0);
        return best_;
    }

private:
    void visit(std::size_t a, std::size_t b) {
        const auto &m = moving_.nodes()[a], &f = fixed_.nodes()[b];
        const Vec3 apart = (m.box.low - f.box.high).cwiseMax(f.box.low - m.box.high).cwiseMax(0.0);
        if (apart.squaredNorm() > best_ * best_ || best_ == 0.0) return;
        if (m.right == 0 && f.right == 0) {
            for (std::size_t i = m.first; i < m.end; ++i)
                for (std::size_t j = f.first; j < f.end; ++j) {
                    const Corners3 first = moving_.cornersOf(i), second = fixed_.cornersOf(j);
                    if (liesBeyond(first, second, best_) || liesBeyond(second, first, best_) ||
                        liesAside(first, second, best_))
                        continue;
                    best_ = std::min(best_, distanceOfTriangles(first, second));
                }
        } else if (f.right == 0 || (m.right != 0 && m.box.size().squaredNorm() > f.box.size().squaredNorm())) {
            visit(a + 1, b);
            visit(m.right, b);
        } else {
            visit(a, b + 1);
            visit(a, f.right);
        }
    }

    BoxTree moving_, fixed_;
    double best_ = 0.0;
};

}  // namespace passung::test
