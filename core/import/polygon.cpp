#include <array>
#include <vector>

#include "core/import/mesh_formats.h"

namespace passung::importer {

namespace {

/// Twice the area vector, by Newell's method.
Vec3 newellNormal(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& corners) {
    Vec3 normal = Vec3::Zero();
    const Vec3& origin = mesh.vertices[corners[0]];
    for (std::size_t k = 0; k < corners.size(); ++k)
        normal += (mesh.vertices[corners[k]] - origin).cross(mesh.vertices[corners[(k + 1) % corners.size()]] - origin);
    return normal;
}

/// Is the corner `k` an ear: convex, and no other corner in its triangle?
bool isEar(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& corners, std::size_t k,
           const Vec3& normal) {
    const std::size_t n = corners.size();
    const std::array<std::uint32_t, 3> ear{corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]};
    const Vec3 &a = mesh.vertices[ear[0]], &b = mesh.vertices[ear[1]], &c = mesh.vertices[ear[2]];
    if (!((b - a).cross(c - b).dot(normal) > 0.0)) return false;
    for (const std::uint32_t v : corners) {
        if (v == ear[0] || v == ear[1] || v == ear[2]) continue;
        const Vec3& p = mesh.vertices[v];
        if ((b - a).cross(p - a).dot(normal) >= 0.0 && (c - b).cross(p - b).dot(normal) >= 0.0 &&
            (a - c).cross(p - c).dot(normal) >= 0.0)
            return false;
    }
    return true;
}

}  // namespace

void addPolygon(geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& corners) {
    std::vector<std::uint32_t> left = corners;
    if (corners.size() > 3) {
        const Vec3 normal = newellNormal(mesh, corners);
        for (std::size_t k = 0, misses = 0; left.size() > 3 && misses < left.size();) {
            if (!isEar(mesh, left, k, normal)) {
                k = (k + 1) % left.size();
                ++misses;
                continue;
            }
            const std::size_t n = left.size();
            mesh.triangles.push_back({left[(k + n - 1) % n], left[k], left[(k + 1) % n]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
            k = (k + 1) % left.size();
            misses = 0;
        }
    }
    for (std::size_t k = 1; k + 1 < left.size(); ++k) mesh.triangles.push_back({left[0], left[k], left[k + 1]});
}

}  // namespace passung::importer
