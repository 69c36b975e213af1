#include "ui/presenter/shaded_mesh.h"

#include <cmath>

namespace passung::presenter {

namespace {

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

ShadedMesh shade(const model::TriangleMesh& mesh, double crease) {
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
    const model::Bounds bounds = model::boundsOf(mesh);
    shaded.low_mm = floats(1e3 * bounds.low);
    shaded.high_mm = floats(1e3 * bounds.high);
    return shaded;
}

}  // namespace passung::presenter
