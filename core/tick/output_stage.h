#pragma once

#include "core/tick/tick_model.h"

namespace passung::tick {

/// What a wrench about the handle's origin in the device's base axes is on the held part: about its origin, world axes.
/// Reads X_WH. rt-safe.
Wrench wrenchOnHeldPart(const TickModel& model, const TickFrame& frame, const Wrench& F_D_B) noexcept;

/// Stage, only if the scene names a delay: the wrench takes effect `delay_ticks` later. What was computed without
/// usable input takes effect as zero.
void delayOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

/// Stage, only if the scene displays no wrench: what was computed goes nowhere; one that is not finite is left for
/// limitOutput to tell.
void withholdWrench(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

/// Stage, the last of every scene: the one place that a wrench leaves through.
///   Reads F_H_W (about the held part's origin), writes F_D_B (what is sent) and F_H_W (what the hand then feels).
///   In this order:
///   1. input not usable → zero;
///   2. not finite → zero, latched until the state is made anew;
///   3. torque dropped where the device has none; force and torque scaled by one factor so that both are within the
///      device's limits (direction kept);
///   4. rising limited: along its direction f̂ the force is at most max(0, f_last · f̂, f_sample · f̂) + rate · T. f_last
///      was sent in the last tick; f_sample in the last one with a new sample, so that after exactly one held tick the
///      force may be back at once where it was before. The torque likewise, with the rate scaled by
///      max_torque / max_force, and with a factor of its own: a torque that turns round must not take the force with
///      it. What falls is passed at once.
///   Invariants: finite; |force| ≤ max_force; |torque| ≤ max_torque. kForceLimited and kRateLimited are set if and only
///   if step 3's factor or one of step 4's changed the wrench; steps 1 and 2 are told by kInputRejected and
///   kNonFiniteLatched. That a device has no torque is a property of the device, not an event.
void limitOutput(const TickModel& model, TickState& state, TickFrame& frame) noexcept;

}  // namespace passung::tick
