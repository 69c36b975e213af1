#include "ui/presenter/shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace passung::presenter {

namespace {

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// True if every edge is run through as often in one direction as in the other and the mesh holds a volume > 0: then
/// whoever is outside meets no triangle from behind first.
bool isClosed(const geometry::TriangleMesh& mesh) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> there, back;
    double volume = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            there.emplace_back(from, to);
            back.emplace_back(to, from);
        }
        volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
    }
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    return volume > 0.0 && there == back;
}

}  // namespace

ShadedMesh shade(const geometry::TriangleMesh& mesh, double crease) {
    const double least = std::cos(crease);
    std::vector<Vec3> areas(mesh.triangles.size());
    std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        areas[t] = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        for (const std::uint32_t corner : mesh.triangles[t]) around[corner].push_back(t);
    }
    ShadedMesh shaded;
    std::vector<std::vector<std::uint32_t>> made(mesh.vertices.size());  // vertices of the result, by old vertex
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const double size = areas[t].norm();
        for (const std::uint32_t corner : mesh.triangles[t]) {
            Vec3 normal = Vec3::Zero();
            for (const std::uint32_t other : around[corner])
                if (areas[other].dot(areas[t]) >= least * size * areas[other].norm()) normal += areas[other];
            const double length = normal.norm();
            if (length > 0) normal /= length;
            const ShadedMesh::Vertex vertex{floats(1e3 * mesh.vertices[corner]), floats(normal)};
            std::uint32_t index = 0;
            bool known = false;
            for (const std::uint32_t candidate : made[corner])
                if (shaded.vertices[candidate] == vertex) index = candidate, known = true;
            if (!known) {
                index = static_cast<std::uint32_t>(shaded.vertices.size());
                shaded.vertices.push_back(vertex);
                made[corner].push_back(index);
            }
            shaded.indices.push_back(index);
        }
    }
    shaded.two_sided = !isClosed(mesh);
    const geometry::Bounds bounds = geometry::boundsOf(mesh);
    shaded.low_mm = floats(1e3 * bounds.low);
    shaded.high_mm = floats(1e3 * bounds.high);
    return shaded;
}

}  // namespace passung::presenter
