#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/mesh.h"
#include "core/shape/shape.h"

/// Meshes with something wrong on purpose, made from sound ones.
namespace passung::test {

/// A closed surface without symmetry: a sphere with waves; φ of the unwaved sphere is no truth for it.
inline geometry::TriangleMesh wavySphere(double diameter, double chord_error) {
    geometry::TriangleMesh mesh = shape::tessellate(shape::Sphere{diameter}, chord_error);
    for (Vec3& v : mesh.vertices) {
        const Vec3 u = 16.0 / diameter * v;
        v *= 1.0 + 0.1 * std::sin(u.x()) * std::cos(0.9 * u.y()) * std::sin(1.1 * u.z() + 0.3);
    }
    return mesh;
}

/// The triangles whose centre lies within `radius` of `centre`.
inline std::vector<std::size_t> patchAround(const geometry::TriangleMesh& mesh, const Vec3& centre, double radius) {
    std::vector<std::size_t> patch;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
        if ((middle - centre).norm() <= radius) patch.push_back(i);
    }
    return patch;
}

/// `share` of the triangles, at random, in order.
inline std::vector<std::size_t> someOf(const geometry::TriangleMesh& mesh, double share, std::uint64_t seed) {
    Random random(seed);
    std::vector<std::size_t> some;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (random.uniform() < share) some.push_back(i);
    return some;
}

inline geometry::TriangleMesh withHole(geometry::TriangleMesh mesh, const std::vector<std::size_t>& patch) {
    for (std::size_t k = patch.size(); k-- > 0;)
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(patch[k]));
    return mesh;
}

inline geometry::TriangleMesh withFlipped(geometry::TriangleMesh mesh, const std::vector<std::size_t>& patch) {
    for (const std::size_t i : patch) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    return mesh;
}

inline geometry::TriangleMesh withDuplicates(geometry::TriangleMesh mesh, const std::vector<std::size_t>& patch) {
    for (const std::size_t i : patch) mesh.triangles.push_back(mesh.triangles[i]);
    return mesh;
}

inline geometry::TriangleMesh insideOut(geometry::TriangleMesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

/// Every triangle with three vertices of its own, as in an STL file.
inline geometry::TriangleMesh unshared(const geometry::TriangleMesh& mesh) {
    geometry::TriangleMesh result;
    for (const auto& t : mesh.triangles) {
        const auto base = static_cast<std::uint32_t>(result.vertices.size());
        for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
        result.triangles.push_back({base, base + 1, base + 2});
    }
    return result;
}

}  // namespace passung::test
