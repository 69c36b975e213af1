#include "ui/presenter/drawn_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/import/mesh_import.h"
#include "core/shape/shape.h"
#include "study/measures/tick_facts.h"
#include "study/plan/scene_parts.h"

namespace passung::presenter {

namespace {

constexpr double kChordError = 0.03e-3;  // of what is drawn [m]: less than a pixel
constexpr double kGround = 4e-3;         // below the lowest part [m]
constexpr double kLine = 0.5e-3;         // radius of a contour [m]
constexpr double kUpright = 1e-6;        // a direction that is less beside the vertical is upright

void extendBy(geometry::Bounds& bounds, const ShadedMesh& mesh, const Pose& X_W) {
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 p;
        for (int i = 0; i < 3; ++i) {
            const auto& side = ((corner >> i) & 1) != 0 ? mesh.high_mm : mesh.low_mm;
            p[i] = 1e-3 * static_cast<double>(side[static_cast<std::size_t>(i)]);
        }
        bounds.extend(X_W * p);
    }
}

/// As the study says; what it does not say so that a sphere of this radius about `middle` fills the picture.
Camera cameraOn(const Vec3& middle, double radius, const plan::View& appearance) {
    Camera camera;
    camera.centre = appearance.camera_target.value_or(middle);
    camera.opening = appearance.camera_opening;
    const double reach = radius + (middle - camera.centre).norm();  // of all that is drawn, from what it looks at
    const double distance = appearance.camera_distance.value_or(reach / std::sin(0.5 * camera.opening));
    const Vec3 back = appearance.camera_from.normalized();
    const Vec3 across = Vec3::UnitZ().cross(back);
    const Vec3 right = across.norm() > kUpright ? across.normalized() : Vec3::UnitX();
    Mat3 axes;
    axes << right, back.cross(right), back;
    camera.X_WC = {Quat(axes), camera.centre + distance * back};
    camera.near = std::max(0.02 * distance, distance - 3.0 * reach);
    camera.far = distance + 8.0 * reach;
    return camera;
}

/// Where no other is asked for: over the camera's left shoulder.
Vec3 lightFrom(const Camera& camera, const plan::View& appearance) {
    return appearance.light_from.value_or(camera.X_WC.q * Vec3(-0.55, 0.5, 0.35) + 1.3 * Vec3::UnitZ()).normalized();
}

Pose recordedPose(const TickRecord& record, plan::ShownPose which) {
    return which == plan::ShownPose::Proxy ? measures::proxyPose(record) : measures::handPose(record);
}

/// None: no hand can pick anything up.
std::optional<DrawnPicking> pickingOf(const plan::Condition& condition) {
    const scene::SceneSpec& spec = condition.scene;
    if (!spec.effects.picks()) return std::nullopt;
    DrawnPicking picking{.X_WHands = {}, .registration = spec.registration, .pick = spec.effects.pick};
    for (std::size_t hand = 0; hand < spec.handCount(); ++hand) picking.X_WHands.push_back(plan::startPose(spec, hand));
    if (const auto* assembly = std::get_if<plan::AssemblyTask>(&condition.task.form)) {
        for (const plan::AskedStep& step : assembly->steps) picking.step_names.push_back(step.name);
        picking.hints = assembly->hints;
        picking.hint_after = assembly->hint_after;
    }
    return picking;
}

/// Where each step's part belongs, each of the others where it starts, or where an earlier step puts it.
void extendByGoals(geometry::Bounds& bounds, const DrawnScene& scene) {
    const std::vector<scene::AssemblyStep>& steps = scene.picking->pick.steps;
    std::vector<Pose> X_WP;
    for (const DrawnPart& part : scene.parts) X_WP.push_back({part.X_W.q, part.X_W.p - part.shown_offset});
    for (const std::size_t i : scene::orderOf(steps)) {
        const std::size_t part = steps[i].part;
        if (part >= X_WP.size()) continue;
        X_WP[part] = scene::goalOf(steps[i], X_WP);
        extendBy(bounds, *scene.parts[part].mesh, {X_WP[part].q, X_WP[part].p + scene.parts[part].shown_offset});
    }
}

}  // namespace

double Camera::metresPerPixel(double height_px) const {
    return 2.0 * (X_WC.p - centre).norm() * std::tan(0.5 * opening) / height_px;
}

Pose DrawnScene::startPose() const {
    if (held < parts.size()) return parts[held].X_W;
    return picking && !picking->X_WHands.empty() ? picking->X_WHands.front() : Pose{};
}

Pose poseOf(const DrawnScene& scene, const TickRecord& record, plan::ShownPose which) {
    Pose X_W = recordedPose(record, which);
    X_W.p += scene.held_offset;
    return X_W;
}

Pose shownPoseOfOther(const DrawnScene& scene, const TickRecord& record) { return recordedPose(record, scene.shown); }

Pose shownPose(const DrawnScene& scene, const TickRecord& record) { return poseOf(scene, record, scene.shown); }

Pose pointerPose(const DrawnScene& scene, const TickRecord& record) {
    if (!scene.picking) return recordedPose(record, plan::ShownPose::Device);
    const scene::Registration& r = scene.picking->registration;
    const auto& p = record.device_position_m;
    const auto& q = record.device_quaternion;
    return r.X_WB * Pose{Quat(q[0], q[1], q[2], q[3]).normalized(), r.scale * Vec3(p[0], p[1], p[2])} * r.X_DH;
}

Result<std::shared_ptr<const ShadedMesh>> SceneArtist::surfaceOf(const scene::PartSpec& part) {
    std::string key;
    const auto* file = std::get_if<scene::MeshFile>(&part.geometry);
    if (file != nullptr) {
        key = fmt::format("{} {}", file->path, file->metres_per_unit);
    } else {
        const auto& shape = std::get<shape::Shape>(part.geometry);
        key = shape::kindName(shape);
        for (const double size : shape::dimensions(shape)) key += fmt::format(" {}", size);
    }
    if (const auto known = surfaces_.find(key); known != surfaces_.end()) return known->second;
    geometry::TriangleMesh mesh;
    if (file != nullptr) {
        auto read = scene::importMeshFile(*file, builds_);
        if (!read) return read.errors();
        mesh = std::move(read->mesh);
    } else {
        mesh = shape::tessellate(std::get<shape::Shape>(part.geometry), kChordError);
    }
    return surfaces_[key] = std::make_shared<const ShadedMesh>(shade(mesh));
}

/// Fits around the held part, whose axis is z; lies in the plane z = 0.
std::shared_ptr<const ShadedMesh> SceneArtist::ringAround(const ShadedMesh& held) {
    const double girth =
        1e-3 * static_cast<double>(std::max(held.high_mm[0] - held.low_mm[0], held.high_mm[1] - held.low_mm[1]));
    scene::PartSpec ring;
    ring.geometry = shape::Shape(shape::Torus{1.5 * girth, 0.045 * girth});
    return *surfaceOf(ring);  // a shape has no file that could be missing
}

std::vector<Mark> SceneArtist::marksOf(const plan::Task& task, const Pose& X_WTarget, const DrawnScene& scene) {
    if (scene.held >= scene.parts.size()) return {};  // what there is to do follows from the steps
    const DrawnPart& held = scene.parts[scene.held];
    if (std::holds_alternative<plan::PegInHoleTask>(task.form)) return {{ringAround(*held.mesh), X_WTarget, false}};
    if (const auto* passage = std::get_if<plan::NarrowPassageTask>(&task.form)) {
        const auto ring = ringAround(*held.mesh);
        return {{ring, X_WTarget, false}, {ring, X_WTarget * Pose{Quat::Identity(), {0, 0, -passage->length}}, false}};
    }
    if (const auto* contour = std::get_if<plan::ContourFollowingTask>(&task.form)) {
        std::string key = "line";
        for (const Vec3& p : contour->points) key += fmt::format(" {} {} {}", p.x(), p.y(), p.z());
        auto& line = surfaces_[key];
        if (!line) line = std::make_shared<const ShadedMesh>(shade(lineThrough(contour->points, kLine)));
        return {{line, X_WTarget, false}};
    }
    if (const auto* placement = std::get_if<plan::FreePlacementTask>(&task.form))
        return {{held.mesh, {placement->X_WGoal.q, placement->X_WGoal.p + scene.held_offset}, true}};
    return {};  // of a pair nothing is to be reached
}

Result<std::shared_ptr<const DrawnScene>> SceneArtist::draw(const plan::Condition& condition,
                                                            const plan::View& appearance) {
    auto scene = std::make_shared<DrawnScene>();
    scene->appearance = appearance;
    scene->shown = condition.shown;
    scene->hidden_in_trial = !condition.shows_scene;
    scene->cues = condition.cues;
    scene->held = DrawnScene::kNothing;
    geometry::Bounds bounds;
    Pose X_WTarget;
    for (const scene::PartSpec& part : condition.scene.parts) {
        auto mesh = surfaceOf(part);
        if (!mesh) return mesh.errors();
        const bool held = part.held && part.hand == 0;
        DrawnPart drawn{.mesh = *mesh,
                        .X_W = {part.X_WP.q, part.X_WP.p + part.shown_offset},
                        .held = held,
                        .pickable = part.pickable,
                        .shown_offset = part.shown_offset};
        if (part.held && part.hand > 0) drawn.other_hand = part.hand - 1;
        if (part.name == condition.task.target) {
            X_WTarget = plan::judgedFrame(condition.task, drawn.X_W);
            scene->target_hand = drawn.other_hand;
        }
        if (held) {
            scene->held = scene->parts.size();
            scene->held_offset = part.shown_offset;
        }
        extendBy(bounds, **mesh, drawn.X_W);
        scene->parts.push_back(std::move(drawn));
    }
    if (std::holds_alternative<plan::FreePlacementTask>(condition.task.form)) scene->target_hand.reset();
    scene->picking = pickingOf(condition);
    if (scene->picking) extendByGoals(bounds, *scene);
    scene->marks = marksOf(condition.task, X_WTarget, *scene);
    for (const Mark& mark : scene->marks) extendBy(bounds, *mark.mesh, mark.X_W);
    scene->floor = bounds.low.z() - kGround;
    scene->radius = 0.5 * bounds.size().norm();
    scene->camera = cameraOn(0.5 * (bounds.low + bounds.high), 1.08 * scene->radius, appearance);
    scene->light_from = lightFrom(scene->camera, appearance);
    return std::shared_ptr<const DrawnScene>(std::move(scene));
}

}  // namespace passung::presenter
