#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Snap: near a place of its own the held part is drawn into it.
///
/// Symbols: H the held part where the hand asks it to be, S a place of it (SnapPlace; of poses that a turn about the
/// part's z axis makes alike the one nearest to H), r the range, K the stiffness, ρ = metric_radius.
///   e = p_S - p_H,  ψ = log(R_S R_Hᵀ),  d² = |e|² + ρ²|ψ|²
///   F = Σ K (1 - d²/r²)² e,   T = Σ K ρ² (1 - d²/r²)² ψ,   over the places with d < r, T about the part's origin
/// Derivation: the gradient of U = -⅙ K r² (1 - d²/r²)³, whose value, slope and curvature are zero at the border.
/// Limit cases: d ≥ r → nothing, not even a zero. In the place → none. Near it → a spring of K, and of K ρ² against
/// turning. |F| is at most 16/(25 √5) K r = 0.286 K r, at d = r/√5.
/// Energy: that of a potential: what it gives on the way in, ⅙ K r² at most, it takes on the way out, for a place at
/// rest. A passivity controller would take it back at once, and is refused.
/// Stability: the stiffest is a spring of K, beside the coupling's; from r/√5 on it pushes like a spring of down to
/// -0.8 K, which a hand that is softer than that feels as a jump into the place.
///
/// Stage, only if the scene names it, of each hand that holds a part which belongs somewhere.
void drawIntoPlace(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles,
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
             return model.effects.snap.any() ? "the held part belongs nowhere"
                                             : "effects.snap is not set, or its stiffness is 0";
         }}};

}  // namespace passung::tick
