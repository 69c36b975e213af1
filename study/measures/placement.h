#pragma once

#include "core/base/tick_record.h"
#include "core/scene/assembly.h"

namespace passung::measures {

/// How far the held part, at the proxy's pose, is from its goal; of a round part the angle is that of its z axis.
scene::GoalError placementError(const TickRecord& record, const Pose& X_WGoal, bool round);

}  // namespace passung::measures
