#pragma once

#include <cstdint>

#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

inline constexpr double kFarthestReading = 1e3;     // [m] from the device's base: no device reaches so far
inline constexpr int kAgreeingSamples = 3;          // jumps that it takes to doubt a pose that nobody confirmed
inline constexpr int kAgreeingSamplesToMove = 200;  // and one that was confirmed: a driver may be stuck for a while
inline constexpr int kLongestSearchGap = 4;         // ticks between two of them: down to 250 Hz

/// Owner: input guard. Read by the energy account.
struct InputGuard {
    bool has_good_pose = false;
    Pose X_BD_good;
    bool good_confirmed = false;  // a sample that followed it, or those that led to it, agree with X_BD_good
    std::int64_t periods_since_good = 0;
    Pose X_BD_other;        // the last sample that does not follow from X_BD_good
    int other_samples = 0;  // that led to it, each following from the one before
    std::int64_t periods_since_other = 0;
};

/// Owner: start gate. Read by whoever walks the stages.
struct Engagement {
    bool engaged = false;
    int held_ticks = 0;
};

/// Stage: a device that lies or stalls. Until there is a good sample the hand is where the proxy is.
///   A sample is bad if it is not fresh (kDeviceStale), is no pose (kInputNotAPose: not finite, no unit quaternion,
///   farther than kFarthestReading) or does not follow from the last good one (kInputJump: moved farther than max_speed
///   and max_spin allow for the time in between; q and -q are the same rotation). What then acts is a second bit:
///   - kInputHeld: one bad sample, the last good pose holds;
///   - kInputRejected: more of them, or no good sample yet: the output is zero until a good one comes.
///   Back again: the first sample that follows from the last good one (the allowed distance grows with time), or, where
///   none does, the last of so many jumps that follow from one another (kInputRelocated). Few where the last good
///   sample was confirmed by no other and may be the false one: then the device is back within kAgreeingSamples ticks.
///   Many where it was, so that a driver that repeats one wrong pose for a fifth of a second moves nothing. The first
///   sample of all, and the first after rejected ones, has nothing to be judged by and is taken at its word; but it is
///   not held against a jump: the output is zero until samples agree again. Limit case: a device that is slower than
///   the tick (fresh every other tick) is held on each tick between.
void guardInput(const HandModel& model, const Reading& device, const Grip& grip, const Proxy& proxy, InputGuard& guard,
                HandSample& hand, Report& report) noexcept;
inline constexpr StageOf kInputGuard{
    guardInput,
    {.name = "input guard",
     .parameters = "device.max_speed_m_per_s, device.registration",
     .cost = "constant",
     .senses = true,
     .before_start = true,
     .needs = [](const HandModel&) { return true; },
     .reason = [](const HandModel&) { return "always: a device may lie, stall or vanish"; }}};

/// Stage: the trial begins when the hand holds the start pose.
///   Opens after hold_ticks ticks within the tolerances; never closes again. While it is closed only the stages marked
///   before_start run, so that the output is zero.
void waitForStartPose(const HandModel& model, const HandSample& hand, Engagement& gate) noexcept;
inline constexpr StageOf kStartGate{
    waitForStartPose,
    {.name = "start gate",
     .parameters = "start_gate",
     .cost = "constant",
     .senses = true,
     .before_start = true,
     .needs = [](const HandModel& model) { return model.start_gate.hold_ticks > 0; },
     .reason = [](const HandModel&) { return "start_gate is set: contact begins when the hand holds the start pose"; },
     .spared = [](const HandModel&) { return "start_gate is not set: contact is there from the first tick"; }}};

/// Where the held part, or what else is at `X_DH` in the handle, is when the handle is at `X_BD`:
/// X_WH = X_WB · scale(X_BD) · X_DH. rt-safe.
Pose registeredPose(const scene::Registration& registration, const Pose& X_BD, const Pose& X_DH) noexcept;

}  // namespace passung::tick
