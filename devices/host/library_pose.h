#pragma once

#include "core/base/types.h"
#include "devices/unit/axes.h"
#include "devices/unit/link.h"

namespace passung::host {

inline constexpr double kFarthest = 1.0;  // [m]: beyond any device that stands on a table, but near in mm

/// What a library's rotation matrix and position [m] say, or why they cannot be.
unit::Exchange saidPose(const Mat3& R, const Vec3& p, const unit::Axes& axes);

}  // namespace passung::host
