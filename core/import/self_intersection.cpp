#include "core/import/self_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/triangle_tree.h"

namespace passung::importer {

namespace {

/// What rounding may make of a volume that is zero, as a share of the product of the lengths that span it.
constexpr double kTouching = 1e-9;
/// Of one triangle: a pile of thousands upon one place is found by fewer.
constexpr std::size_t kMostNeighbours = 256;

struct CyclicCorners {
    std::array<Vec3, 3> at;
    const Vec3& operator[](std::size_t k) const { return at[k % 3]; }
};

/// Six times the volume of a tetrahedron, 0 if it is flat up to rounding.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double value = u.dot(v.cross(w));
    return std::abs(value) > kTouching * u.norm() * v.norm() * w.norm() ? value : 0.0;
}

/// Strictly: through the triangle's inside, with the ends on two sides of its plane.
bool passesThrough(const Vec3& from, const Vec3& to, const CyclicCorners& t) {
    const double from_side = volume(t[0], t[1], t[2], from), to_side = volume(t[0], t[1], t[2], to);
    if (!(from_side * to_side < 0.0)) return false;
    const double first = volume(from, to, t[0], t[1]), second = volume(from, to, t[1], t[2]),
                 third = volume(from, to, t[2], t[0]);
    return (first > 0.0 && second > 0.0 && third > 0.0) || (first < 0.0 && second < 0.0 && third < 0.0);
}

bool cross(const CyclicCorners& a, const CyclicCorners& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (passesThrough(a[k], a[k + 1], b) || passesThrough(b[k], b[k + 1], a)) return true;
    return false;
}

}  // namespace

Crossings crossingsOf(const geometry::TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return {};
    const geometry::TriangleTree tree(mesh);
    const auto cornersOf = [&](std::size_t i) {
        const geometry::Triangle& t = mesh.triangles[i];
        return CyclicCorners{{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}};
    };
    Crossings found;
    std::vector<char> crossing(mesh.triangles.size(), 0);
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const CyclicCorners corners = cornersOf(i);
        geometry::Bounds box;
        for (const Vec3& corner : corners.at) box.extend(corner);
        tree.collectWithin(box, kMostNeighbours, near);
        for (const std::uint32_t k : near) {
            if (k <= i || !cross(corners, cornersOf(k))) continue;
            crossing[i] = crossing[k] = 1;
            found.pairs += 2;
        }
    }
    found.triangles = static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), 1));
    return found;
}

}  // namespace passung::importer
