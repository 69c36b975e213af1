#pragma once

#include "core/tick/tick_model.h"

namespace passung::tick {

/// Stage: a device that lies or stalls.
///   Reads the raw reading; writes the last good pose, X_WH, input_usable.
///   A sample is bad if it is not finite, has no unit quaternion, is not fresh, or has moved farther from the last good
///   one than max_speed and max_spin allow for the time in between. One bad sample: the last good pose holds. More:
///   the output is zero until a good one comes (the allowed distance grows with time, so that a device that was really
///   carried elsewhere comes back).
void guardInput(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

/// Stage: the trial begins when the hand holds the start pose.
///   Reads X_WH; writes engaged. Opens after hold_ticks ticks within the tolerances; never closes again. While it is
///   closed only the stages marked before_start run, so that the output is zero.
void waitForStartPose(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

/// Where the held part is when the handle is at `X_BD`: X_WH = X_WB · scale(X_BD) · X_DH. rt-safe.
Pose registeredPose(const model::Registration& registration, const Pose& X_BD) noexcept;

}  // namespace passung::tick
