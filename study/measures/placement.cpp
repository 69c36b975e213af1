#include "study/measures/placement.h"

#include "study/measures/tick_facts.h"
#include "study/measures/type_measures.h"

namespace passung::measures {

scene::GoalError placementError(const TickRecord& record, const Pose& X_WGoal, bool round) {
    const auto& q = record.proxy_quaternion;
    return scene::goalError({Quat(q[0], q[1], q[2], q[3]), proxyPosition(record)}, X_WGoal, round ? 0 : 1);
}

namespace {

/// At the confirmation; nothing without one.
std::optional<scene::GoalError> errorOf(const Trial& trial) {
    const auto* facts = std::get_if<PlacementFacts>(&trial.context.form);
    const bool confirmed = trial.succeeded() || trial.context.outcome == Outcome::Failure;
    if (facts == nullptr || !confirmed || trial.points.empty()) return std::nullopt;
    return placementError(trial.points.back(), trial.context.X_WT, facts->round);
}

Optional positionError(const Trial& trial) {
    const auto error = errorOf(trial);
    return error ? Optional(error->position) : std::nullopt;
}

Optional angleError(const Trial& trial) {
    const auto error = errorOf(trial);
    return error ? Optional(error->angle) : std::nullopt;
}

}  // namespace

std::vector<Measure> placementMeasures() {
    return {
        {{"position_error_m", "Position error at the confirmation", "m",
          "distance of the proxy's origin from the goal at the end tick; empty without confirmation"},
         positionError},
        {{"angle_error_rad", "Angle error at the confirmation", "rad",
          "angle of the rotation from the goal to the proxy at the end tick, 0 to pi; with task.symmetric_about_z the "
          "angle between their z axes; empty without confirmation"},
         angleError},
    };
}

}  // namespace passung::measures
