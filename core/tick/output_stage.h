#pragma once

#include "core/tick/tick_model.h"

namespace passung::tick {

/// Stage, only if the scene names a delay: the wrench takes effect `delay_ticks` later.
void delayOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

/// Stage, the last of every scene: the one place that a wrench leaves through.
///   Reads F_H_W (about the held part's origin), writes F_D_B (what is sent) and F_H_W (what the hand then feels).
///   In this order:
///   1. input not usable → zero;
///   2. not finite → zero, latched until the state is made anew;
///   3. torque dropped where the device has none; force and torque scaled by one factor so that both are within the
///      device's limits (direction kept);
///   4. rising limited: along the new direction f̂ at most max(0, f_last · f̂) + rate · T; the same for the torque with
///      the rate scaled by max_torque / max_force; one factor for both. A wrench that falls is passed at once.
///   Invariants: finite; |force| ≤ max_force; |torque| ≤ max_torque; status says which guard acted.
void limitOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

}  // namespace passung::tick
