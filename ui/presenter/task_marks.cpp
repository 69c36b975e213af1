#include "ui/presenter/task_marks.h"

#include "core/shape/shape.h"

namespace passung::presenter {

namespace {

void append(geometry::TriangleMesh& mesh, const geometry::TriangleMesh& piece, const Pose& X) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& vertex : piece.vertices) mesh.vertices.push_back(X * vertex);
    for (const auto& [a, b, c] : piece.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

geometry::TriangleMesh lineThrough(const std::vector<Vec3>& points, double radius) {
    const double coarse = 0.1 * radius;
    const geometry::TriangleMesh corner = shape::tessellate(shape::Sphere{2.0 * radius}, coarse);
    geometry::TriangleMesh mesh;
    for (const Vec3& point : points) append(mesh, corner, {Quat::Identity(), point});
    for (std::size_t i = 1; i < points.size(); ++i) {
        const Vec3 way = points[i] - points[i - 1];
        if (!(way.norm() > 0.0)) continue;
        append(mesh, shape::tessellate(shape::Cylinder{2.0 * radius, way.norm()}, coarse),
               {rotationBetween(Vec3::UnitZ(), way), 0.5 * (points[i - 1] + points[i])});
    }
    return mesh;
}

}  // namespace passung::presenter
