#include "study/protocol/start_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/plan/scene_parts.h"

namespace passung::protocol {
namespace {

constexpr double kStepsPerSize = 24.0;        // points are this part of the longest side apart
constexpr double kChordOfPoints = 0.005;      // of the triangles that carry the points
constexpr double kSurfaceRounding = 1e-9;     // [m]: what rounding leaves of a point on the surface
constexpr std::size_t kManyTriangles = 4000;  // of a mesh: then its corners stand for it
constexpr std::size_t kMostCorners = 6000;

struct Placed {
    const scene::PartSpec& part;
    Pose X_WP;
    const geometry::TriangleMesh& mesh;
    geometry::Bounds bounds;
};

const shape::Shape* shapeOf(const scene::PartSpec& part) { return std::get_if<shape::Shape>(&part.geometry); }

/// The part's surface as triangles; empty if its mesh cannot be read.
geometry::TriangleMesh surfaceOf(const scene::PartSpec& part, PartGeometries& geometries) {
    if (const auto* shape = shapeOf(part)) {
        const geometry::TriangleMesh fine = shape::tessellate(*shape, 1e-3);  // for its size only
        return shape::tessellate(*shape, kChordOfPoints * geometry::boundsOf(fine).size().maxCoeff());
    }
    const PartSurface* geometry = geometries.of(part);
    return geometry != nullptr ? *geometry->mesh : geometry::TriangleMesh{};
}

/// Calls `visit` for points of the surface; not with those of a chord in front of a round hole, where nothing is.
template <class Visit>
void visitPoints(const Placed& part, const Visit& visit) {
    const shape::Shape* shape = shapeOf(part.part);
    if (shape == nullptr && part.mesh.triangles.size() > kManyTriangles) {
        const std::size_t every = 1 + part.mesh.vertices.size() / kMostCorners;
        for (std::size_t i = 0; i < part.mesh.vertices.size(); i += every) visit(part.mesh.vertices[i]);
        return;
    }
    const double step = part.bounds.size().maxCoeff() / kStepsPerSize;
    for (const geometry::Triangle& t : part.mesh.triangles) {
        const Vec3& a = part.mesh.vertices[t[0]];
        const Vec3 ab = part.mesh.vertices[t[1]] - a, ac = part.mesh.vertices[t[2]] - a;
        const int n = std::max(1, static_cast<int>(std::ceil(std::max(ab.norm(), ac.norm()) / step)));
        for (int i = 0; i <= n; ++i) {
            for (int k = 0; k <= n - i; ++k) {
                const Vec3 p = a + (ab * i + ac * k) / n;
                if (shape == nullptr || shape::signedDistance(*shape, p) <= kSurfaceRounding) visit(p);
            }
        }
    }
}

/// How deep points of `part`'s surface stand in `obstacle` [m].
double depthOf(const Placed& part, const Placed& obstacle, PartGeometries& geometries) {
    const Pose X_OP = obstacle.X_WP.inverse() * part.X_WP;
    const Vec3 centre = 0.5 * (part.bounds.low + part.bounds.high);
    const double half = 0.51 * part.bounds.size().norm();
    if (geometries.signedDistance(obstacle.part, X_OP * centre) > half) return 0.0;
    double deepest = 0.0;
    // Of parts that coincide no point of a surface is inside.
    if (geometries.signedDistance(part.part, centre) < 0.0)
        deepest = std::max(0.0, std::min(-geometries.signedDistance(part.part, centre),
                                         -geometries.signedDistance(obstacle.part, X_OP * centre)));
    visitPoints(part, [&](const Vec3& p) {
        const Vec3 q = X_OP * p;
        const bool far =
            ((q - obstacle.bounds.low).array() < 0.0).any() || ((obstacle.bounds.high - q).array() < 0.0).any();
        if (!far) deepest = std::max(deepest, -geometries.signedDistance(obstacle.part, q));
    });
    return deepest;
}

}  // namespace

double depthAt(const scene::PartSpec& part, const Pose& X_WP, const scene::PartSpec& obstacle,
               PartGeometries& geometries) {
    const auto text = [](const Pose& X) {
        return fmt::format("{:a} {:a} {:a} {:a} {:a} {:a} {:a}", X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(),
                           X.q.z());
    };
    const std::string question =
        fmt::format("{} at {} in {} at {}", geometryKey(part), text(X_WP), geometryKey(obstacle), text(obstacle.X_WP));
    return geometries.remembered(question, [&] {
        const geometry::TriangleMesh one = surfaceOf(part, geometries), other = surfaceOf(obstacle, geometries);
        if (one.triangles.empty() || other.triangles.empty()) return 0.0;
        const Placed held{part, X_WP, one, geometry::boundsOf(one)};
        const Placed still{obstacle, obstacle.X_WP, other, geometry::boundsOf(other)};
        return std::max(depthOf(held, still, geometries), depthOf(still, held, geometries));
    });
}

double startDepth(const scene::PartSpec& held, const scene::PartSpec& obstacle) {
    PartGeometries geometries;
    return depthAt(held, held.X_WP, obstacle, geometries);
}

void checkStartPose(const Node& scene, const std::string& path, const scene::SceneSpec& spec,
                    PartGeometries& geometries, Errors& errors) {
    const Node* parts = scene.find("part");
    if (parts == nullptr) return;
    for (const scene::PartSpec& held : spec.parts) {
        if (!held.moves()) continue;
        const Node& table = parts->items[static_cast<std::size_t>(&held - spec.parts.data())];
        const Node* pose = table.find("pose");
        const Node* position = pose != nullptr ? pose->find("position") : nullptr;
        const Node& where = position != nullptr ? *position : pose != nullptr ? *pose : table;
        for (const scene::PartSpec& obstacle : spec.parts) {
            // Itself, and each pair once.
            if (obstacle.held && held.held ? obstacle.hand <= held.hand : obstacle.moves() && &obstacle <= &held)
                continue;
            const double depth = depthAt(held, held.X_WP, obstacle, geometries);
            if (!(depth > spec.contact.tolerance)) continue;
            errors.push_back(
                errorAt(where.place, fmt::format("{}.part.{}.pose", path, held.name),
                        position != nullptr ? valueText(*position) : "",
                        fmt::format("the held part starts {:.3g} mm deep in part {}, more than the field's tolerance "
                                    "of {:.3g} mm: move it out",
                                    1e3 * depth, obstacle.name, 1e3 * spec.contact.tolerance)));
        }
    }
}

}  // namespace passung::protocol
