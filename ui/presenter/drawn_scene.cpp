#include "ui/presenter/drawn_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/model/mesh_import.h"
#include "core/model/shape.h"

namespace passung::presenter {

namespace {

constexpr double kChordError = 0.03e-3;   // of what is drawn [m]: less than a pixel
const Vec3 kFromWhere(0.34, -1.0, 0.62);  // the eye, seen from the scene: a step to the right, half above
constexpr double kGround = 4e-3;          // below the lowest part [m]

model::Bounds boundsOf(const ShadedMesh& mesh, const Pose& X_W) {
    model::Bounds bounds;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 p;
        for (int i = 0; i < 3; ++i) {
            const auto& side = ((corner >> i) & 1) != 0 ? mesh.high_mm : mesh.low_mm;
            p[i] = 1e-3 * static_cast<double>(side[static_cast<std::size_t>(i)]);
        }
        bounds.extend(X_W * p);
    }
    return bounds;
}

/// Looks at `centre` so that a sphere of this radius fills the picture.
Camera cameraOn(const Vec3& centre, double radius) {
    Camera camera;
    camera.centre = centre;
    const double distance = radius / std::sin(0.5 * camera.opening);
    const Vec3 back = kFromWhere.normalized();
    const Vec3 right = Vec3::UnitZ().cross(back).normalized();
    Mat3 axes;
    axes << right, back.cross(right), back;
    camera.X_WC = {Quat(axes), centre + distance * back};
    camera.near = std::max(0.02 * distance, distance - 3.0 * radius);
    camera.far = distance + 8.0 * radius;
    return camera;
}

}  // namespace

double Camera::metresPerPixel(double height_px) const {
    return 2.0 * (X_WC.p - centre).norm() * std::tan(0.5 * opening) / height_px;
}

Pose shownPose(const DrawnScene& scene, const TickRecord& record) {
    const bool proxy = scene.shown == protocol::ShownPose::Proxy;
    const auto& p = proxy ? record.proxy_position_m : record.hand_position_m;
    const auto& q = proxy ? record.proxy_quaternion : record.hand_quaternion;
    const Eigen::Quaternionf rotation(q[0], q[1], q[2], q[3]);
    return {rotation.cast<double>().normalized(), Vec3(p[0], p[1], p[2]) + scene.held_offset};
}

Result<std::shared_ptr<const ShadedMesh>> SceneArtist::surfaceOf(const model::PartSpec& part) {
    std::string key;
    const auto* file = std::get_if<model::MeshFile>(&part.geometry);
    if (file != nullptr) {
        key = fmt::format("{} {}", file->path, file->metres_per_unit);
    } else {
        const auto& shape = std::get<model::Shape>(part.geometry);
        key = model::kindName(shape);
        for (const double size : model::dimensions(shape)) key += fmt::format(" {}", size);
    }
    if (const auto known = surfaces_.find(key); known != surfaces_.end()) return known->second;
    model::TriangleMesh mesh;
    if (file != nullptr) {
        auto read = model::importMesh(file->path, file->metres_per_unit);
        if (!read) return read.errors();
        mesh = std::move(read->mesh);
    } else {
        mesh = model::tessellate(std::get<model::Shape>(part.geometry), kChordError);
    }
    return surfaces_[key] = std::make_shared<const ShadedMesh>(shade(mesh));
}

Result<std::shared_ptr<const DrawnScene>> SceneArtist::draw(const protocol::Condition& condition) {
    auto scene = std::make_shared<DrawnScene>();
    scene->shown = condition.shown;
    scene->cues = condition.cues;
    model::Bounds bounds;
    double girth = 0.01;  // of the held part across its axis z [m]
    for (const model::PartSpec& part : condition.scene.parts) {
        auto mesh = surfaceOf(part);
        if (!mesh) return mesh.errors();
        DrawnPart drawn{*mesh, {part.X_WP.q, part.X_WP.p + part.shown_offset}, part.held, false};
        drawn.target = part.name == condition.task.target;
        if (drawn.target) scene->X_WTarget = drawn.X_W;
        if (part.held) {
            scene->held = scene->parts.size();
            scene->held_offset = part.shown_offset;
            const ShadedMesh& m = **mesh;
            girth = 1e-3 * static_cast<double>(std::max(m.high_mm[0] - m.low_mm[0], m.high_mm[1] - m.low_mm[1]));
        }
        const model::Bounds box = boundsOf(**mesh, drawn.X_W);
        bounds.extend(box.low);
        bounds.extend(box.high);
        scene->parts.push_back(std::move(drawn));
    }
    const model::Torus ring{1.5 * girth, 0.045 * girth};
    model::PartSpec mark_part;
    mark_part.geometry = model::Shape(ring);
    auto mark = surfaceOf(mark_part);
    if (!mark) return mark.errors();
    scene->mark = *mark;
    scene->floor = bounds.low.z() - kGround;
    scene->radius = 0.5 * bounds.size().norm();
    scene->camera = cameraOn(0.5 * (bounds.low + bounds.high), 1.08 * scene->radius);
    return std::shared_ptr<const DrawnScene>(std::move(scene));
}

}  // namespace passung::presenter
