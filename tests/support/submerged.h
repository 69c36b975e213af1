#pragma once

#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::test {

/// Volume of a closed mesh below z = 0 and its first moment, by clipping every triangle at the plane and summing the
/// tetrahedra to a point of the plane: the cut face lies in the plane and adds nothing.
struct Submerged {
    double volume = 0.0;
    Vec3 moment = Vec3::Zero();  // ∫ x dV
};

inline Submerged submerged(const geometry::TriangleMesh& mesh, const Pose& X_WM) {
    Submerged sum;
    for (const auto& t : mesh.triangles) {
        std::vector<Vec3> polygon;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = X_WM * mesh.vertices[t[k]], b = X_WM * mesh.vertices[t[(k + 1) % 3]];
            if (a.z() <= 0) polygon.push_back(a);
            if ((a.z() < 0) != (b.z() < 0)) polygon.push_back(a + (b - a) * (a.z() / (a.z() - b.z())));
        }
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            const double volume = polygon[0].dot(polygon[k - 1].cross(polygon[k])) / 6;
            sum.volume += volume;
            sum.moment += volume * (polygon[0] + polygon[k - 1] + polygon[k]) / 4;  // centroid with the origin
        }
    }
    return sum;
}

}  // namespace passung::test
