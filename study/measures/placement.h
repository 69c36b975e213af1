#pragma once

#include "core/base/tick_record.h"
#include "study/measures/measures.h"

namespace passung::measures {

/// How far the held part, at the proxy's pose, is from its goal.
struct PlacementError {
    double position = 0.0;  // [m], of its origin
    double angle = 0.0;     // [rad], 0 … π; of a round part that of its z axis
};
PlacementError placementError(const TickRecord& record, const Pose& X_WGoal, bool round);

}  // namespace passung::measures
