#pragma once

#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Snap: near a place of its own the held part is drawn into it.
///
/// Symbols: H the held part where the hand asks it to be, S a place of it (SnapPlace; of poses that a turn about the
/// part's z axis makes alike the one that H needs the least turn to), c the point that the hand holds (grip.h), of a
/// part that may turn by any angle the point beside it on that axis; r the range, K the stiffness, ρ² = K_φ/K_c of the
/// coupling.
///   e = c_S - c_H,  ψ = log(R_S R_Hᵀ),  d² = |e|² + ρ²|ψ|²
///   F = Σ K (1 - d²/r²)² e,   T = Σ K ρ² (1 - d²/r²)² ψ,   over the places with d < r, T about c_H
/// Derivation: the gradient of U = -⅙ K r² (1 - d²/r²)³, whose value, slope and curvature are zero at the border. By c,
/// not by the part's origin: a part that is held far from it would be as stiff against turning as K times that length
/// squared. S does not move with H but for turns about the axis, which e and ψ do not see.
/// Limit cases: d ≥ r → zero. In the place → zero. Near it → a spring of K, and of K ρ² against turning; K_φ = 0: turns
/// do not count, and no torque. |F| is at most 16/(25 √5) K r = 0.286 K r, at d = r/√5. Where two poses that look alike
/// are equally near, and within the range, T turns from the one to the other.
/// Energy: that of a potential: what it gives on the way in, ⅙ K r² at most, it takes on the way out, for a place at
/// rest. A passivity controller would take it back at once, and is refused.
/// Stability: of one place the stiffest is a spring of K, beside the coupling's; `check` refuses places of one part
/// whose ranges meet. From r/√5 on it pushes like a spring of down to -0.8 K, which a hand that is softer than that
/// feels as a jump into the place. A part that may turn by any angle and is held at l from its axis is stiffer by K l²
/// against turns about what is across both.
///
/// Stage, only if the scene names it, of each hand that holds a part which belongs somewhere; of two hands on one part
/// that which held it first.
void drawIntoPlace(const HandModel& model, const HandSample& hand, const Grip& grip, const ObstaclePoses& obstacles,
                   SnapShare& added) noexcept;
inline constexpr StageOf kSnap{
    drawIntoPlace,
    {.name = "snap",
     .parameters = "effects.snap, goals of the task's steps",
     .cost = "a little for each place",
     .needs = [](const HandModel& model) { return !model.snap_places.empty(); },
     .reason = [](const HandModel&) { return "effects.snap is set: near its place the held part is drawn into it"; },
     .spared =
         [](const HandModel& model) {
             return model.effects.snap.any() ? "the hand holds nothing that belongs somewhere"
                                             : "effects.snap is not set, or its stiffness is 0";
         }}};

}  // namespace passung::tick
