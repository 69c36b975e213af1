#include "study/protocol/start_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/protocol/scene_parts.h"

namespace passung::protocol {
namespace {

constexpr double kStepsPerSize = 24.0;   // points are this part of the longest side apart
constexpr double kChordPerSize = 0.005;  // of the triangles that carry the points
constexpr double kOnSurface = 1e-9;      // [m]: what rounding leaves of a point on the surface

struct Placed {
    const model::Shape& shape;
    const Pose& X_WP;
    model::TriangleMesh mesh;
    model::Bounds bounds;
};

Placed place(const model::Shape& shape, const Pose& X_WP) {
    const model::TriangleMesh fine = model::tessellate(shape, 1e-3);  // for its size only
    const double longest = model::boundsOf(fine).size().maxCoeff();
    auto mesh = model::tessellate(shape, kChordPerSize * longest);
    auto bounds = model::boundsOf(mesh);
    return {shape, X_WP, std::move(mesh), bounds};
}

/// How deep points of `part`'s surface stand in `obstacle` [m].
double depthOf(const Placed& part, const Placed& obstacle) {
    const Pose X_OP = obstacle.X_WP.inverse() * part.X_WP;
    const Vec3 size = part.bounds.size();
    const Vec3 centre = 0.5 * (part.bounds.low + part.bounds.high);
    if (model::signedDistance(obstacle.shape, X_OP * centre) > 0.51 * size.norm()) return 0.0;
    const double step = size.maxCoeff() / kStepsPerSize;
    double deepest = 0.0;
    for (const model::Triangle& t : part.mesh.triangles) {
        const Vec3& a = part.mesh.vertices[t[0]];
        const Vec3 ab = part.mesh.vertices[t[1]] - a, ac = part.mesh.vertices[t[2]] - a;
        const int n = std::max(1, static_cast<int>(std::ceil(std::max(ab.norm(), ac.norm()) / step)));
        for (int i = 0; i <= n; ++i) {
            for (int k = 0; k <= n - i; ++k) {
                const Vec3 p = a + (ab * i + ac * k) / n;
                const double depth = -model::signedDistance(obstacle.shape, X_OP * p);
                // A chord of a round hole lies in front of the true surface, where nothing is.
                if (depth > deepest && model::signedDistance(part.shape, p) <= kOnSurface) deepest = depth;
            }
        }
    }
    return deepest;
}

}  // namespace

double startDepth(const model::PartSpec& held, const model::PartSpec& obstacle) {
    const auto* held_shape = std::get_if<model::Shape>(&held.geometry);
    const auto* obstacle_shape = std::get_if<model::Shape>(&obstacle.geometry);
    if (held_shape == nullptr || obstacle_shape == nullptr) return 0.0;
    const Placed one = place(*held_shape, held.X_WP), other = place(*obstacle_shape, obstacle.X_WP);
    return std::max(depthOf(one, other), depthOf(other, one));
}

void checkStartPose(const Node& scene, const std::string& path, const model::SceneSpec& spec, Errors& errors) {
    const model::PartSpec* held = heldPart(spec);
    const Node* parts = scene.find("part");
    if (held == nullptr || parts == nullptr) return;
    const Node& table = parts->items[static_cast<std::size_t>(held - spec.parts.data())];
    const Node* pose = table.find("pose");
    const Node* position = pose != nullptr ? pose->find("position") : nullptr;
    const Node& where = position != nullptr ? *position : pose != nullptr ? *pose : table;
    for (const model::PartSpec& obstacle : spec.parts) {
        if (obstacle.held) continue;
        const double depth = startDepth(*held, obstacle);
        if (!(depth > spec.contact.tolerance)) continue;
        errors.push_back(
            errorAt(where.place, fmt::format("{}.part.{}.pose", path, held->name),
                    position != nullptr ? valueText(*position) : "",
                    fmt::format("the held part starts {:.3g} mm deep in part {}, more than the field's tolerance of "
                                "{:.3g} mm: move it out",
                                1e3 * depth, obstacle.name, 1e3 * spec.contact.tolerance)));
    }
}

}  // namespace passung::protocol
