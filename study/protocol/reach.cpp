#include "study/protocol/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "study/plan/scene_parts.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/start_pose.h"

namespace passung::protocol {
namespace {

constexpr double kSmallPart = 2e-3, kLargePart = 2.0;     // [m] of a held part: beyond it is likely a slip in the unit
constexpr double kUsualPart = 0.05;                       // [m] that a likely unit comes near
constexpr double kFastest = 1.0;                          // [m/s] that a hand keeps up on average
constexpr double kTilt = 5.0 * std::numbers::pi / 180.0;  // that a bore of usual clearance bears
constexpr double kRounding = 1e-9;                        // [m]
constexpr int kTurnSteps = 144;                           // of a whole turn

double turnBetween(const Quat& a, const Quat& b) { return Eigen::AngleAxisd(a.conjugate() * b).angle(); }

double tiltBetween(const Quat& a, const Quat& b) {
    return std::acos(std::clamp((a * Vec3::UnitZ()).dot(b * Vec3::UnitZ()), -1.0, 1.0));
}

std::string millimetres(double metres) { return fmt::format("{:.4g} mm", 1e3 * metres); }

/// One trial's geometry against one device.
class ReachCheck {
public:
    ReachCheck(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
               PartGeometries& geometries, Errors& errors, std::vector<std::string>& warnings)
        : tables_(tables),
          scene_(condition.scene),
          task_(condition.task),
          device_(device),
          geometries_(geometries),
          errors_(errors),
          warnings_(warnings),
          held_(*plan::heldPart(condition.scene)),
          target_(plan::partNamed(condition.scene, condition.task.target)) {}

    void run() {
        checkUnits();
        const Node& pose = heldPose();
        reach(held_.X_WP, 0.0, pose, fmt::format("scene.part.{}.pose", held_.name), "the start");
        checkStart();
        const scene::Effects& effects = scene_.effects;
        if (effects.guidance.share > 0.0) checkPoses("guidance", "way", effects.guidance.X_WG, "the guide's way");
        if (effects.snap.any()) checkPoses("snap", "at", effects.snap.X_WG, "a place that draws the part");
        std::visit([this](const auto& form) { check(form); }, task_.form);
    }

private:
    void check(const plan::PegInHoleTask& peg) {
        if (target_ == nullptr) return;
        const Node& at = valueOf("target");
        // Its axis along the bore's, by the shortest turn: a round peg may keep its yaw.
        const Pose X_WMouth = target_->X_WP * peg.X_TMouth;
        const Vec3 along = X_WMouth.q * Vec3::UnitZ();
        const Quat upright = rotationBetween(held_.X_WP.q * Vec3::UnitZ(), along) * held_.X_WP.q;
        const Pose end{upright, X_WMouth * Vec3(0, 0, -peg.success_fraction * peg.insertion_depth)};
        reach(end, 0.0, at, "task.target", "the end of the insertion");
        handleTurns(tiltBetween(held_.X_WP.q, end.q), kTilt, at, "task.target");
        for (const scene::PartSpec& other : scene_.parts)
            if (other.name != task_.target) overlapAt(end, other, scene_.contact.tolerance, at, "task.target");
        way((end.p - held_.X_WP.p).norm());
    }

    void check(const plan::NarrowPassageTask& passage) {
        if (target_ == nullptr) return;
        const Node& at = valueOf("target");
        for (const double depth : {0.0, passage.length}) {
            Pose through{held_.X_WP.q, target_->X_WP * Vec3(0, 0, -depth)};
            reach(through, 0.5 * passage.width, at, "task.target",
                  depth > 0.0 ? "the end of the passage" : "the passage's mouth");
        }
        fitsThrough(passage, at);
        way((target_->X_WP * Vec3(0, 0, -passage.length) - held_.X_WP.p).norm());
    }

    void check(const plan::ContourFollowingTask& contour) {
        if (target_ == nullptr) return;
        const auto& items = valueOf("points").items;
        double length = 0.0;
        for (std::size_t i = 0; i < contour.points.size() && i < items.size(); ++i) {
            const Vec3 p = target_->X_WP * contour.points[i];
            reach({held_.X_WP.q, p}, contour.reach, items[i], "task.points", "this corner of the line");
            length += (p - (i > 0 ? target_->X_WP * contour.points[i - 1] : held_.X_WP.p)).norm();
            for (const scene::PartSpec& other : scene_.parts) {
                if (other.held || geometries_.of(other) == nullptr) continue;
                const double depth = -geometries_.signedDistance(other, other.X_WP.inverse() * p);
                if (depth > contour.reach)
                    fail(items[i], "task.points",
                         fmt::format("lies {} deep in part {}, farther than reach_mm from where the held part can be",
                                     millimetres(depth), other.name));
            }
        }
        if (contour.force > scene_.limits.max_force)
            fail(valueOf("force_N"), "task.force_N",
                 fmt::format("is more than {} gives: {:.4g} N", device_.name, scene_.limits.max_force));
        way(length * contour.coverage);
    }

    void check(const plan::FreePlacementTask& placement) {
        const Node& at = valueOf("position");
        reach(placement.X_WGoal, placement.position_tolerance, at, "task.position", "the goal");
        const double turn = placement.round ? tiltBetween(held_.X_WP.q, placement.X_WGoal.q)
                                            : turnBetween(held_.X_WP.q, placement.X_WGoal.q);
        const Node* rotation = tables_.task.find("rotation_deg");
        handleTurns(turn, placement.angle_tolerance, rotation != nullptr ? *rotation : at, "task.rotation_deg");
        const double slack = std::max(scene_.contact.tolerance, placement.position_tolerance);
        for (const scene::PartSpec& other : scene_.parts)
            overlapAt(placement.X_WGoal, other, slack, at, "task.position");
        const scene::SecondScale& second = scene_.effects.navigation.second_scale;
        const double scale =
            second.button > 0 ? std::min(second.scale, scene_.registration.scale) : scene_.registration.scale;
        const double quantum = scene_.limits.quantum * scale;
        if (placement.position_tolerance < quantum)
            fail(valueOf("position_tolerance_mm"), "task.position_tolerance_mm",
                 fmt::format("is finer than an encoder step of {}: {}", device_.name, millimetres(quantum)));
        way((placement.X_WGoal.p - held_.X_WP.p).norm());
    }

    void check(const plan::AssemblyTask&) {}

    /// Some place of the target comes within reach of the held part.
    void check(const plan::DiscriminationPairTask&) {
        const PartSurface* held = geometries_.of(held_);
        if (target_ == nullptr || held == nullptr || geometries_.of(*target_) == nullptr) return;
        const scene::Registration& r = scene_.registration;
        const Quat handle = r.X_WB.q.conjugate() * held_.X_WP.q * r.X_DH.q.conjugate();
        const Vec3 middle = (r.X_WB * Pose{handle, Vec3::Zero()} * r.X_DH).p;  // of all places of the held part
        const double away = geometries_.signedDistance(*target_, target_->X_WP.inverse() * middle);
        const double reached = device_.workspace_radius_m * r.scale + held->longest();
        if (away > reached && !roams())
            fail(valueOf("target"), "task.target",
                 fmt::format("is {} from the middle of the workspace of {}, where the held part touches what is within "
                             "{}{}",
                             millimetres(away), device_.name, millimetres(reached), unitHint(away)));
    }

    /// The hand gets to any place of the scene (core/tick/navigation.h); a trial begins where the registration says.
    bool roams() const {
        const scene::Navigation& navigation = scene_.effects.navigation;
        return navigation.clutch.button > 0 || navigation.drift.share > 0.0 ||
               scene_.hand(0).largestScale() > scene_.registration.scale;
    }
    static bool same(const Pose& a, const Pose& b) { return a.p == b.p && a.q.coeffs() == b.q.coeffs(); }

    /// Where the handle is when the held part is at `X_WH` [m], device space.
    Vec3 handleAt(const Pose& X_WH) const {
        const scene::Registration& r = scene_.registration;
        return (r.X_WB.inverse() * X_WH * r.X_DH.inverse()).p / r.scale;
    }

    void reach(const Pose& X_WH, double slack, const Node& at, const char* key, const char* what) {
        reach(X_WH, slack, at, std::string(key), what);
    }
    void reach(const Pose& X_WH, double slack, const Node& at, const std::string& key, const char* what) {
        if (roams() && !same(X_WH, held_.X_WP)) return;
        const double far = handleAt(X_WH).norm(), radius = device_.workspace_radius_m;
        if (far <= radius + slack / scene_.registration.scale + kRounding) return;
        const double scale = scene_.registration.scale;
        fail(at, key,
             fmt::format("{} is {} from the middle of the workspace of {}, which reaches {}{}: move it, or `position` "
                         "or `scale` of the registration{}",
                         what, millimetres(far), device_.name, millimetres(radius),
                         scale != 1.0 ? " of the handle's way" : "", unitHint(scale * far)));
    }

    void overlapAt(const Pose& X_WH, const scene::PartSpec& other, double slack, const Node& at, const char* key) {
        if (other.held) return;
        const double depth = depthAt(held_, X_WH, other, geometries_);
        if (depth > slack)
            fail(at, key,
                 fmt::format("there the held part stands {} deep in part {}, more than the tolerance of {}",
                             millimetres(depth), other.name, millimetres(slack)));
    }

    /// As it starts, or with any of its axes along the passage, turned about that by steps of 2.5 degrees; a handle
    /// that does not turn leaves the first alone.
    void fitsThrough(const plan::NarrowPassageTask& passage, const Node& at) {
        const Vec3 along = target_->X_WP.q * Vec3::UnitZ(), middle = target_->X_WP * Vec3(0, 0, -0.5 * passage.length);
        const double allowed = scene_.contact.tolerance + 0.5 * passage.width;
        double least = depthAt(held_, {held_.X_WP.q, middle}, *target_, geometries_);
        const bool turns = device_.sensed_degrees >= 6;
        for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)})
            for (const double way : {1.0, -1.0})
                for (int step = 0; turns && step < kTurnSteps && least > allowed; ++step) {
                    const Quat laid = rotationBetween(held_.X_WP.q * (way * axis), along) * held_.X_WP.q;
                    const Quat turn(Eigen::AngleAxisd(step * 2.0 * std::numbers::pi / kTurnSteps, along));
                    least = std::min(least, depthAt(held_, {turn * laid, middle}, *target_, geometries_));
                }
        if (least > allowed)
            fail(at, "task.target",
                 fmt::format("the held part does not fit through: in the middle of the passage it stands {} deep in {}",
                             millimetres(least), target_->name));
    }

    void handleTurns(double turn, double allowed, const Node& at, const std::string& key) {
        if (device_.sensed_degrees >= 6 || turn <= allowed + 1e-9) return;
        fail(at, key,
             fmt::format("asks for a turn of {:.3g} degrees, but the handle of {} does not turn",
                         turn * 180.0 / std::numbers::pi, device_.name));
    }

    void checkStart() {
        const scene::StartGate& gate = scene_.start_gate;
        const double quantum = scene_.limits.quantum * scene_.registration.scale;
        if (gate.position_tolerance > 0.0 && gate.position_tolerance < quantum)
            fail(inTable(tables_.scene, "start_gate", "position_tolerance_mm"),
                 "scene.start_gate.position_tolerance_mm",
                 fmt::format("is finer than an encoder step of {}: {}", device_.name, millimetres(quantum)));
        const double farthest = (handleAt(held_.X_WP).norm() + device_.workspace_radius_m) * scene_.registration.scale;
        if (task_.leave_radius >= farthest && !roams() &&
            !std::holds_alternative<plan::DiscriminationPairTask>(task_.form))
            fail(valueOf("leave_radius_mm"), "task.leave_radius_mm",
                 fmt::format("no way on {} leaves this sphere: at most {}", device_.name, millimetres(farthest)));
    }

    /// The hand can follow to each of an effect's poses. `what`: of the effect, in words.
    void checkPoses(const char* effect, const char* key, std::span<const Pose> poses, const char* what) {
        const Node* effects = tables_.scene.find("effects");
        const Node* table = effects != nullptr ? effects->find(effect) : nullptr;
        const Node* list = table != nullptr ? table->find(key) : nullptr;
        if (list == nullptr) return;
        const std::string path = fmt::format("scene.effects.{}.{}", effect, key);
        for (std::size_t i = 0; i < list->items.size(); ++i) {
            reach(poses[i], 0.0, list->items[i], path, what);
            handleTurns(poses[i].q.angularDistance(held_.X_WP.q), 0.0, list->items[i], path);
        }
    }

    /// [m] from the start to the end of the task.
    void way(double length) {
        if (length > kFastest * task_.timeout)
            fail(valueOf("timeout_s"), "task.timeout_s",
                 fmt::format("is too short for a way of {}: a hand takes more than {:.3g} s", millimetres(length),
                             length / kFastest));
        const double across = 2.0 * device_.workspace_radius_m * scene_.registration.scale;
        const bool direct = !std::holds_alternative<plan::ContourFollowingTask>(task_.form);
        if (direct && length > across && !roams())
            warn(fmt::format("the way from the start to the target, {}, is longer than the workspace of {}, {}{}",
                             millimetres(length), device_.name, millimetres(across), unitHint(length)));
    }

    void checkUnits() {
        const PartSurface* geometry = geometries_.of(held_);
        if (geometry == nullptr || !(geometry->longest() > 0.0)) return;
        const double size = geometry->longest();
        if (size < kSmallPart || size > kLargePart)
            warn(fmt::format("the held part {} is {} long, {} than usual{}", held_.name, millimetres(size),
                             size < kSmallPart ? "smaller" : "larger", unitHint(size)));
    }

    /// Which unit would make a length usual, if another than the scene's does.
    std::string unitHint(double length) const {
        const Node* unit = tables_.scene.find("unit");
        const std::string name = unit != nullptr ? unit->text : "mm";
        const auto own =
            std::find_if(kLengthUnits.begin(), kLengthUnits.end(), [&](const auto& u) { return name == u.name; });
        if (own == kLengthUnits.end()) return "";
        const auto strangeness = [&](const LengthUnit& u) {
            return std::abs(std::log(length * own->per_metre / u.per_metre / kUsualPart));
        };
        const auto likely =
            std::min_element(kLengthUnits.begin(), kLengthUnits.end(),
                             [&](const auto& a, const auto& b) { return strangeness(a) < strangeness(b); });
        if (likely->per_metre == own->per_metre || strangeness(*own) < std::log(8.0)) return "";
        return fmt::format("; lengths are in {}: is \"{}\" meant?", name, likely->name);
    }

    void warn(std::string sentence) {
        if (std::find(warnings_.begin(), warnings_.end(), sentence) == warnings_.end())
            warnings_.push_back(std::move(sentence));
    }

    void fail(const Node& at, const std::string& key, std::string message) {
        const bool plain = at.kind != Node::Kind::Table;
        errors_.push_back(errorAt(at.place, key, plain ? valueText(at) : "", std::move(message)));
    }

    const Node& heldPose() const {
        for (const Node& part : tables_.scene.find("part")->items) {
            if (part.find("name")->text != held_.name) continue;
            const Node* pose = part.find("pose");
            const Node* position = pose != nullptr ? pose->find("position") : nullptr;
            return position != nullptr ? *position : pose != nullptr ? *pose : part;
        }
        return tables_.scene;
    }

    /// The key's value in [task], or the table where it is absent.
    const Node& valueOf(const char* key) const {
        const Node* value = tables_.task.find(key);
        return value != nullptr ? *value : tables_.task;
    }
    static const Node& inTable(const Node& root, const char* table, const char* key) {
        const Node* node = root.find(table);
        const Node* value = node != nullptr ? node->find(key) : nullptr;
        return value != nullptr ? *value : root;
    }

    const StudyTables& tables_;
    const scene::SceneSpec& scene_;
    const plan::Task& task_;
    const DeviceDescription& device_;
    PartGeometries& geometries_;
    Errors& errors_;
    std::vector<std::string>& warnings_;
    const scene::PartSpec& held_;
    const scene::PartSpec* target_;
};

}  // namespace

void checkReach(const StudyTables& tables, const plan::Condition& condition, const DeviceDescription& device,
                PartGeometries& geometries, Errors& errors, std::vector<std::string>& warnings) {
    if (plan::heldPart(condition.scene) == nullptr) return;  // of what is picked up the steps are looked at
    ReachCheck(tables, condition, device, geometries, errors, warnings).run();
}

const Node* numberAt(const Node& scene, const std::string& path) {
    const Node* node = &scene;
    std::string_view rest = path;
    while (node != nullptr && !rest.empty()) {
        const std::size_t dot = std::min(rest.find('.'), rest.size());
        const std::string_view key = rest.substr(0, dot);
        rest.remove_prefix(std::min(dot + 1, rest.size()));
        if (node->kind == Node::Kind::List) {
            const auto part = std::find_if(node->items.begin(), node->items.end(), [&](const Node& item) {
                const Node* name = item.find("name");
                return name != nullptr && name->text == key;
            });
            node = part != node->items.end() ? &*part : nullptr;
        } else {
            node = node->find(key);
        }
    }
    const bool number = node != nullptr && (node->kind == Node::Kind::Integer || node->kind == Node::Kind::Number);
    return number ? node : nullptr;
}

}  // namespace passung::protocol
