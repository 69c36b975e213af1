#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

/// Plain sums and searches over all triangles of a mesh, by other formulas than the core uses: a truth for tests.
namespace passung::test {

template <class T>
using Vec3Of = Eigen::Matrix<T, 3, 1>;

template <class T>
T distanceToSegment(const Vec3Of<T>& p, const Vec3Of<T>& a, const Vec3Of<T>& b) {
    const Vec3Of<T> e = b - a;
    if (e.squaredNorm() == T(0)) return (p - a).norm();
    const T t = std::clamp((p - a).dot(e) / e.squaredNorm(), T(0), T(1));
    return (a + t * e - p).norm();
}

/// Height over the plane if the foot lies in the triangle (same side of the three edges), else the nearest edge. Three
/// points in a line have no plane: only edges.
template <class T>
T distanceToTriangleIn(const Vec3Of<T>& p, const Vec3Of<T>& a, const Vec3Of<T>& b, const Vec3Of<T>& c, T flat) {
    const Vec3Of<T> normal = (b - a).cross(c - a);
    const T longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    const bool above = normal.norm() > flat * longest2 && (b - a).cross(p - a).dot(normal) >= T(0) &&
                       (c - b).cross(p - b).dot(normal) >= T(0) && (a - c).cross(p - c).dot(normal) >= T(0);
    if (above) return std::abs((p - a).dot(normal.normalized()));
    return std::min({distanceToSegment<T>(p, a, b), distanceToSegment<T>(p, b, c), distanceToSegment<T>(p, c, a)});
}

/// Triangles much longer than high need more digits.
inline double distanceToTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if ((b - a).cross(c - a).norm() > 1e-3 * longest2) return distanceToTriangleIn<double>(p, a, b, c, 0.0);
    using Long = long double;
    return static_cast<double>(
        distanceToTriangleIn<Long>(p.cast<Long>(), a.cast<Long>(), b.cast<Long>(), c.cast<Long>(), Long(1e-10)));
}

inline double distanceToTriangle(const geometry::TriangleMesh& mesh, std::size_t i, const Vec3& p) {
    const auto& t = mesh.triangles[i];
    return distanceToTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
}

/// Triangles whose box is farther away than the best so far are left out.
inline double distanceToMesh(const geometry::TriangleMesh& mesh, const Vec3& p) {
    double best = 1e150;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const Vec3 outside = (a.cwiseMin(b).cwiseMin(c) - p).cwiseMax(p - a.cwiseMax(b).cwiseMax(c)).cwiseMax(0.0);
        if (outside.squaredNorm() <= best * best) best = std::min(best, distanceToTriangle(mesh, i, p));
    }
    return best;
}

/// Solid angle by Girard's theorem: the angles between the planes through p and the edges, less π.
inline double solidAngle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = (a - p).normalized(), v = (b - p).normalized(), w = (c - p).normalized();
    const double side = u.dot(v.cross(w));
    const auto angle = [](const Vec3& at, const Vec3& from, const Vec3& to) {
        const Vec3 m = at.cross(from), n = at.cross(to);
        return std::atan2(m.cross(n).norm(), m.dot(n));
    };
    const double excess = angle(u, v, w) + angle(v, w, u) + angle(w, u, v) - std::numbers::pi;
    return side < 0.0 ? -excess : excess;
}

inline double windingNumber(const geometry::TriangleMesh& mesh, const Vec3& p) {
    double sum = 0.0;
    for (const auto& t : mesh.triangles)
        sum += solidAngle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    return sum / (4.0 * std::numbers::pi);
}

inline double volume(const geometry::TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& t : mesh.triangles)
        sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
    return sum;
}

inline double area(const geometry::TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        sum += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    }
    return sum;
}

struct EdgeCount {
    std::size_t open = 0;     // directed edges without their opposite
    std::size_t crowded = 0;  // directed edges used more than once
};

inline EdgeCount countEdges(const geometry::TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    EdgeCount result;
    for (const auto& [edge, n] : uses) {
        result.crowded += n > 1 ? 1 : 0;
        result.open += uses.count({edge.second, edge.first}) == 0 ? 1 : 0;
    }
    return result;
}

}  // namespace passung::test
