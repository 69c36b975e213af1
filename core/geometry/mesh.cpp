#include "core/geometry/mesh.h"

#include <bit>
#include <string>

#include "core/base/random.h"

namespace passung::geometry {

namespace {

/// Little-endian.
void append(std::string& bytes, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xffu));
}

}  // namespace

Bounds boundsOf(const TriangleMesh& mesh) {
    Bounds bounds;
    for (const Vec3& vertex : mesh.vertices) bounds.extend(vertex);
    return bounds;
}

std::uint64_t contentHash(const TriangleMesh& mesh) {
    std::string bytes;
    bytes.reserve(16 + 24 * mesh.vertices.size() + 12 * mesh.triangles.size());
    append(bytes, mesh.vertices.size(), 8);
    append(bytes, mesh.triangles.size(), 8);
    for (const Vec3& vertex : mesh.vertices)
        for (const double coordinate : vertex) append(bytes, std::bit_cast<std::uint64_t>(coordinate), 8);
    for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) append(bytes, corner, 4);
    return fnv1a64(bytes);
}

}  // namespace passung::geometry
