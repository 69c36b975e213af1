#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Owner: guidance.
struct Guiding {
    double gone = 0.0;  // along HandModel::way [m]
};

/// Shared control: a guide goes along a way, and a spring draws the hand after it.
/// Sources: a spring to a reference that moves, weighted by a share, is what Abbink, Mulder and Boer (2012) call haptic
/// shared control at a level of authority; the part of the way beside the line is a virtual fixture (Rosenberg, 1993).
///
/// Symbols: H the held part where the hand asks it to be, X(s) the way at s (guide_way.h), s the guide's place, h the
/// hand's: where the way is nearest to H, of what lies within the lead ℓ of s; v the guide's speed, T the tick; K, K_φ
/// its stiffness, σ the share.
///   s ← max(s, min(h + ℓ, max(s, h) + v T))          it waits for the hand, is never behind it, never turns back
///   e = p(s) - p_H,  ψ = log(R(s) R_Hᵀ)
///   F = σ K e min(1, ℓ/|e|),   T = σ K_φ ψ min(1, ℓ/(ρ|ψ|)),   ρ = metric_radius, T about the part's origin
/// so that a hand that does not follow, or is drawn aside, meets at most σ K ℓ and σ K_φ ℓ/ρ.
/// Limit cases: σ = 0 → no stage at all. A hand held fast → |F| = σ K ℓ from ℓ/v on. Nobody in the way → the hand
/// follows at v, its own resistance to that over σ K behind. At the way's end the guide stays and holds it there.
/// A part that something keeps from following feels contact and guide, each its own: the proxy stays, its coupling
/// tells.
///
/// Energy: a guide that goes ahead gives energy out, that is what it is for: at most σ K ℓ times the way's length. The
/// account books it (passivity.h); beside it a passivity controller would take it back, and is refused.
/// Stability: beside a coupling the hand feels both springs, K and σ K_guide.
///
/// Stage, only if the scene names it: of the first hand, once the trial has begun; without usable input the guide waits
/// and pulls at nothing.
void guideHand(const HandModel& model, const HandSample& hand, Guiding& guide, GuidanceShare& added) noexcept;
inline constexpr StageOf kGuidance{
    guideHand,
    {.name = "guidance",
     .parameters = "effects.guidance",
     .cost = "a little for each pose of the way",
     .needs = [](const HandModel& model) { return model.effects.guidance.share > 0.0; },
     .reason = [](const HandModel&) { return "effects.guidance has a share above 0: a guide draws the hand along"; },
     .spared = [](const HandModel&) { return "effects.guidance is not set, or its share is 0"; }}};

}  // namespace passung::tick
