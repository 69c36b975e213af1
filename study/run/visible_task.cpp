#include "study/run/visible_task.h"

#include "study/plan/scene_parts.h"

namespace passung::run {

simulated::VisibleTask visibleTask(const plan::Condition& condition) {
    const auto shown = [](const scene::PartSpec& part) { return Pose{part.X_WP.q, part.X_WP.p + part.shown_offset}; };
    simulated::VisibleTask task;
    if (const auto* held = plan::heldPart(condition.scene)) task.X_WHeldStart = shown(*held);
    if (const auto* target = plan::partNamed(condition.scene, condition.task.target)) {
        task.X_WTarget = shown(*target);
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
        task.goal = simulated::CompareGoal{pair->judged == plan::Judged::Roughness};
    return task;
}

simulated::VisibleTask holdingTask(const plan::Condition& condition, std::size_t hand) {
    simulated::VisibleTask task;
    task.X_WHeldStart = condition.scene.parts[condition.scene.heldBy(hand)].X_WP;
    task.goal = simulated::HoldGoal{};
    return task;
}

}  // namespace passung::run
