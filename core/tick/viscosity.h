#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Owner: viscosity.
struct Stirring {
    Pose X_WH_last;  // at the last good new sample
    Twist V;         // of the held part, smoothed
    bool has_last = false;
};

inline constexpr double kStirringTime = 3e-3;  // [s] of the smoothing: encoder steps, and no motion of a hand

/// Viscosity: the held part moves as in a fluid, wherever it is and whatever it touches.
///
/// Symbols: V = (v, ω) the twist of H about the part's origin from good sample to good sample (twist_between.h), n
/// ticks apart, τ = kStirringTime, T the tick; b, b_φ the scene's dampings.
///   V̄ += (1 - exp(-n T/τ)) (V - V̄)
///   F = -b v̄,   T = -b_φ ω̄
/// V̄ is a first-order low-pass, exact for a twist that holds from sample to sample. Encoder steps q make V jump by
/// q/T: smoothed, a third of that.
/// Limit cases: steady motion → F = -b v after some τ; at f the size falls by (2πfτ)²/2: 1 % at 7.5 Hz. At rest → none.
/// Passivity: that of a damper behind a low-pass: it takes energy in below 1/(2πτ) = 53 Hz, and of what moves faster it
/// takes less. A held sample leaves V̄. After samples that were rejected it starts from nothing.
///
/// Stage, only if the scene names it.
void resistMotion(const HandModel& model, const HandSample& hand, Stirring& stirring, ViscosityShare& added) noexcept;
inline constexpr StageOf kViscosity{
    resistMotion,
    {.name = "viscosity",
     .parameters = "effects.viscosity",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.effects.viscosity.any(); },
     .reason = [](const HandModel&) { return "effects.viscosity is set: a damper resists the held part's motion"; },
     .spared = [](const HandModel&) { return "effects.viscosity is not set, or its dampings are 0"; }}};

}  // namespace passung::tick
