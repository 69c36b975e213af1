#include "core/geometry/surface_walk.h"

#include <algorithm>

#include "core/geometry/mesh_edges.h"

namespace passung::geometry {

namespace {

std::uint32_t edgeIn(const TriangleMesh& mesh, const HalfEdge& edge) {
    const Triangle& t = mesh.triangles[edge.triangle];
    const std::uint32_t from = edge.forward ? edge.low : edge.high, to = edge.forward ? edge.high : edge.low;
    std::uint32_t k = 0;
    while (k < 2 && !(t[k] == from && t[(k + 1) % 3] == to)) ++k;
    return k;
}

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleMesh& mesh) {
    faces_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        const std::array<Vec3, 3> c{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
        const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized();
        Face face;
        face.normal = normal.cast<float>();
        face.across.fill(kNone);
        for (std::size_t k = 0; k < 3; ++k) {
            face.corner[k] = c[k].cast<float>();
            face.inward[k] = normal.cross(c[(k + 1) % 3] - c[k]).stableNormalized().cast<float>();
        }
        faces_.push_back(face);
    }
    forEachEdge(halfEdges(mesh.triangles), [&](const HalfEdge* edge, std::size_t uses) {
        if (uses != 2 || edge[0].triangle == edge[1].triangle) return;
        const std::uint32_t a = edgeIn(mesh, edge[0]), b = edgeIn(mesh, edge[1]);
        faces_[edge[0].triangle].across[a] = 4 * edge[1].triangle + b;
        faces_[edge[1].triangle].across[b] = 4 * edge[0].triangle + a;
    });
}

SurfaceWalk::WalkPlace SurfaceWalk::moved(WalkPlace place, Eigen::Vector3f step) const noexcept {
    const Face* face = &faces_[place.triangle];
    step -= face->normal.dot(step) * face->normal;
    std::size_t entry = 3;
    for (int i = 0; i < kMostFaces && face->normal != Eigen::Vector3f::Zero(); ++i) {
        // The edge that the way meets first, but not the one that it came over.
        std::size_t exit = 3;
        float share = 1.0f;
        for (std::size_t k = 0; k < 3; ++k) {
            const float speed = -face->inward[k].dot(step);
            const float room = std::max(0.0f, face->inward[k].dot(place.position - face->corner[k]));
            if (k == entry || !(room < share * speed)) continue;
            share = room / speed;
            exit = k;
        }
        place.position += share * step;
        if (exit == 3 || face->across[exit] == kNone) return place;
        // The part along the edge stays, the part across it turns into the next triangle.
        const Eigen::Vector3f along = face->inward[exit].cross(face->normal);
        const float out = -face->inward[exit].dot(step);
        place.triangle = face->across[exit] / 4;
        entry = face->across[exit] % 4;
        face = &faces_[place.triangle];
        step = (1.0f - share) * (along.dot(step) * along + out * face->inward[entry]);
    }
    return place;
}

}  // namespace passung::geometry
