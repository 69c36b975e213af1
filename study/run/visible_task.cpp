#include "study/run/visible_task.h"

#include "study/plan/scene_parts.h"

namespace passung::app {

simulated::VisibleTask visibleTask(const protocol::Condition& condition) {
    const auto shown = [](const model::PartSpec& part) { return Pose{part.X_WP.q, part.X_WP.p + part.shown_offset}; };
    simulated::VisibleTask task;
    if (const auto* held = protocol::heldPart(condition.scene)) task.X_WHeldStart = shown(*held);
    if (const auto* target = protocol::partNamed(condition.scene, condition.task.target))
        task.X_WTarget = shown(*target);
    const auto& form = condition.task.form;
    if (const auto* peg = std::get_if<protocol::PegInHoleTask>(&form))
        task.insertion_depth = peg->insertion_depth;
    else if (const auto* passage = std::get_if<protocol::NarrowPassageTask>(&form))
        task.insertion_depth = passage->length;  // through a passage one goes as into a bore
    else if (const auto* contour = std::get_if<protocol::ContourFollowingTask>(&form))
        task.goal = simulated::FollowGoal{contour->points, contour->force};
    else if (const auto* placement = std::get_if<protocol::FreePlacementTask>(&form))
        task.goal = simulated::PlaceGoal{placement->X_WGoal, placement->round};
    else if (const auto* pair = std::get_if<protocol::DiscriminationPairTask>(&form))
        task.goal = simulated::CompareGoal{pair->judged == protocol::Judged::Roughness};
    return task;
}

}  // namespace passung::app
