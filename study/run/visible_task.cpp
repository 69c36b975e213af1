#include "study/run/visible_task.h"

#include <limits>
#include <string>
#include <variant>

#include "core/geometry/triangle_distance.h"
#include "core/shape/shape.h"
#include "devices/simulated/presets.h"
#include "study/plan/scene_parts.h"

namespace passung::run {
namespace {

constexpr double kChordError = 1e-4;  // [m] of the surface that a hand looks for a grip on
constexpr double kGripBelow = 0.2;    // of a part's height: so far below its top it is taken

Vec3 closestOn(const geometry::TriangleMesh& mesh, const Vec3& p) {
    Vec3 closest = p;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : mesh.triangles) {
        const Vec3 q = geometry::closestOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        if (!((q - p).norm() < least)) continue;
        least = (q - p).norm();
        closest = q;
    }
    return closest;
}

/// Of a mesh nobody says: it may be turned in vain.
bool looksRound(const scene::PartSpec& part) {
    const auto* shape = std::get_if<shape::Shape>(&part.geometry);
    return shape != nullptr && shape::isRound(*shape);
}

Pose shownPose(const scene::PartSpec& part) { return {part.X_WP.q, part.X_WP.p + part.shown_offset}; }

/// A point of the surface near the part's top, where people take it.
void findGrip(const geometry::TriangleMesh& mesh, simulated::AssembleGoal::Part& part) {
    if (mesh.vertices.empty()) return;
    const geometry::Bounds box = geometry::boundsOf(mesh);
    Vec3 wanted = 0.5 * (box.low + box.high);
    wanted.z() = box.high.z() - kGripBelow * box.size().z();
    part.grip = closestOn(mesh, wanted);
    part.below = -box.low.z();
}

simulated::Quantity quantityOf(plan::Judged judged) {
    switch (judged) {
        case plan::Judged::Stiffness:
            return simulated::Quantity::Stiffness;
        case plan::Judged::Roughness:
            return simulated::Quantity::Roughness;
        case plan::Judged::Force:
            return simulated::Quantity::Force;
        case plan::Judged::Viscosity:
            return simulated::Quantity::Viscosity;
        case plan::Judged::Inertia:
            return simulated::Quantity::Inertia;
        case plan::Judged::Position:
            return simulated::Quantity::Position;
    }
    return simulated::Quantity::Stiffness;
}

/// Of each hand, in the world. Navigation takes a hand everywhere.
std::vector<simulated::AssembleGoal::Reach> reachesOf(const plan::Condition& condition) {
    std::vector<simulated::AssembleGoal::Reach> reaches;
    for (std::size_t hand = 0; hand < condition.scene.handCount(); ++hand) {
        const std::string* name = hand == 0 ? &condition.device : nullptr;
        if (hand > 0 && hand <= condition.other_devices.size()) name = &condition.other_devices[hand - 1];
        const scene::HandSpec spec = condition.scene.hand(hand);
        const auto* device = name != nullptr ? simulated::findPreset(*name) : nullptr;
        auto& reach = reaches.emplace_back();
        if (device == nullptr || spec.navigation.any()) continue;
        reach = {spec.registration.X_WB.p, spec.registration.scale * device->workspace_radius.value};
    }
    return reaches;
}

simulated::VisibleTask assemblyTask(const plan::Condition& condition, const plan::AssemblyTask& asked, std::size_t hand,
                                    BuiltParts parts) {
    const scene::Pick& pick = condition.scene.effects.pick;
    simulated::AssembleGoal goal;
    for (const scene::PartSpec& part : condition.scene.parts)
        goal.parts.push_back({.X_W = shownPose(part), .shown_offset = part.shown_offset});
    for (std::size_t i = 0; i < pick.steps.size(); ++i) {
        const scene::AssemblyStep& step = pick.steps[i];
        const bool described = i < asked.steps.size();
        goal.steps.push_back(
            {.part = static_cast<std::int32_t>(step.part),
             .into = step.into == scene::AssemblyStep::kWorld ? -1 : static_cast<std::int32_t>(step.into),
             .X_IGoal = step.X_IGoal,
             .folds = step.folds,
             .insertion = described ? asked.steps[i].insertion : 0.0,
             .after = step.after,
             .hand = described ? asked.steps[i].hand : 0});
        const auto* shape = std::get_if<shape::Shape>(&condition.scene.parts[step.part].geometry);
        if (shape != nullptr)
            findGrip(shape::tessellate(*shape, kChordError), goal.parts[step.part]);
        else if (step.part < parts.size())
            findGrip(parts[step.part]->mesh, goal.parts[step.part]);
    }
    goal.close = 1u << (pick.button - 1);
    goal.hand = hand;
    goal.reaches = reachesOf(condition);
    goal.on_press = pick.on_press;
    simulated::VisibleTask task;
    task.blind = !condition.shows_scene;
    task.X_WHeldStart = plan::startPose(condition.scene, hand);
    task.goal = std::move(goal);
    return task;
}

}  // namespace

simulated::VisibleTask visibleTask(const plan::Condition& condition, BuiltParts parts) {
    if (const auto* assembly = std::get_if<plan::AssemblyTask>(&condition.task.form))
        return assemblyTask(condition, *assembly, 0, parts);
    simulated::VisibleTask task;
    task.blind = !condition.shows_scene;
    if (const auto* held = plan::heldPart(condition.scene)) {
        task.X_WHeldStart = shownPose(*held);
        task.round = looksRound(*held);
    }
    if (const auto* target = plan::partNamed(condition.scene, condition.task.target)) {
        task.X_WTarget = plan::judgedFrame(condition.task, shownPose(*target));
        if (target->held && target->hand > 0) task.target_hand = target->hand;
    }
    const auto& form = condition.task.form;
    if (const auto* peg = std::get_if<plan::PegInHoleTask>(&form))
        task.insertion_depth = peg->insertion_depth;
    else if (const auto* passage = std::get_if<plan::NarrowPassageTask>(&form))
        task.insertion_depth = passage->length;  // through a passage one goes as into a bore
    else if (const auto* contour = std::get_if<plan::ContourFollowingTask>(&form))
        task.goal = simulated::FollowGoal{contour->points, contour->force};
    else if (const auto* placement = std::get_if<plan::FreePlacementTask>(&form))
        task.goal = simulated::PlaceGoal{placement->X_WGoal, placement->round};
    else if (const auto* pair = std::get_if<plan::DiscriminationPairTask>(&form))
        task.goal = simulated::CompareGoal{quantityOf(pair->judged)};
    return task;
}

simulated::VisibleTask otherTask(const plan::Condition& condition, std::size_t hand, BuiltParts parts) {
    if (const auto* assembly = std::get_if<plan::AssemblyTask>(&condition.task.form))
        return assemblyTask(condition, *assembly, hand, parts);
    simulated::VisibleTask task;
    task.X_WHeldStart = condition.scene.parts[condition.scene.heldBy(hand)].X_WP;
    task.goal = simulated::HoldGoal{};
    return task;
}

}  // namespace passung::run
