#pragma once

#include <array>
#include <vector>

#include "core/tick/energy_account.h"
#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Owner: output delay.
struct DelayLine {
    std::size_t place = 0;  // of this tick; the next one is the oldest
    std::array<Wrench, scene::kMaxDelayTicks + 1> delay_line{};
    std::vector<FewOfMany<Wrench>> push_line;  // the same of the obstacles' pushes
};

/// Owner: output limits. Read by the energy account.
struct SentWrench {
    Wrench last_sent;                  // F_D_B of the previous tick
    Wrench sent_at_sample;             // F_D_B of the last tick with a new sample
    bool latched = false;              // a computed wrench was not finite
    double weighed = 0.0;              // share of the held part's weight that is in last_sent, 0 … 1
    FewOfMany<Wrench> last_shares{1};  // of last_sent, as EnergyAccounts::pairs
};

/// From the handle's origin, or its image in the scene (navigation.h), to the held part's, world axes [m]. rt-safe.
Vec3 leverOf(const HandSample& hand, const Grip& grip) noexcept;

/// What a wrench about the handle's origin in the device's base axes is on the held part: about its origin, world axes.
/// rt-safe.
Wrench wrenchOnHeldPart(const HandModel& model, const HandSample& hand, const Grip& grip, const Wrench& F_D_B) noexcept;

/// Stage, only if the scene names a delay: the wrench takes effect `delay_ticks` later. What was computed without
/// usable input takes effect as zero.
void delayOutput(const HandModel& model, const HandSample& hand, DelayLine& line, Pushes& pushes,
                 HandWrench& wrench) noexcept;
inline constexpr StageOf kOutputDelay{delayOutput,
                                      {.name = "output delay",
                                       .parameters = "device.delay_ticks",
                                       .cost = "constant, and a little for each obstacle that pushes",
                                       .before_start = true,
                                       .needs = [](const HandModel& model) { return model.limits.delay_ticks > 0; },
                                       .reason = [](const HandModel&) { return "device.delay_ticks is set"; },
                                       .spared = [](const HandModel&) { return "device.delay_ticks is 0"; }}};

/// Stage, only if the scene displays no wrench: what was computed goes nowhere; one that is not finite is left for
/// limitOutput to tell.
void withholdWrench(const HandModel& model, Pushes& pushes, HandWrench& wrench, Report& report) noexcept;
inline constexpr StageOf kNoWrench{
    withholdWrench,
    {.name = "no wrench",
     .parameters = "feedback.kinesthetic",
     .cost = "constant, and a little for each obstacle that pushes",
     .before_start = true,
     .needs = [](const HandModel& model) { return !model.display_wrench; },
     .reason =
         [](const HandModel&) { return "feedback.kinesthetic is false: contact is computed, nothing is displayed"; },
     .spared = [](const HandModel&) { return "feedback.kinesthetic is true: the device displays the wrench"; }}};

/// Stage, the last of every scene: the one place that a wrench leaves through.
///   Leaves F_D_B (what is sent) and F_H_W (what the hand then feels).
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
void limitOutput(const HandModel& model, const HandSample& hand, const Grip& grip, const Pushes& pushes,
                 SentWrench& sent, HandWrench& felt, CommandedWrench& command, Report& report) noexcept;
inline constexpr StageOf kOutputLimits{
    limitOutput,
    {.name = "output limits",
     .parameters = "device.max_force_N, max_torque_Nm, max_force_rate_N_per_s, device.registration",
     .cost = "constant, and a little for each obstacle that pushes",
     .before_start = true,
     .needs = [](const HandModel&) { return true; },
     .reason =
         [](const HandModel&) { return "always, last: finite, within the device's limits, rising slowly enough"; }}};

}  // namespace passung::tick
