#pragma once

#include <fstream>
#include <string>

#include "core/geometry/mesh.h"

namespace passung::test {

/// Writes the triangles as an OFF file in metres, without loss.
inline void writeOff(const std::string& path, const geometry::TriangleMesh& mesh) {
    std::ofstream out(path);
    out.precision(17);
    out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
    for (const Vec3& v : mesh.vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
}

}  // namespace passung::test
