#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Vibration after impacts. Owner: contact transients.
struct Ringing {
    Wrench now, next;  // of this tick and of the coming one, without a further impact
    Pose X_WH_last;    // at the last new sample
    bool has_last = false;
    bool in_contact = false;  // at the last tick
};

/// Event-based transients: what a tap feels like, a vibration that dies out, added to the contact's own wrench at every
/// impact. A coupling alone renders all materials alike and soft.
/// Source: Kuchenbecker, Fiene, Niemeyer (2006): open loop, amplitude proportional to the speed of the impact.
///
/// Symbols: F, T wrench of the contact on the hand, about the held part's origin, world axes; v, ω the hand's twist
/// there, from the sample before to this one; A, f, τ the scene's amplitude [N·s/m], frequency and time constant.
///   Impact: there are contacts and a wrench of theirs now, and were not a tick before. Its speed, that of the point in
///   contact along the force,   s = max(0, -(F · v + T · ω)/|F, T|),  |F, T| = max(|F|, |T|/R),  R the distance of the
///   held part's farthest point from o: |F| for one contact, and contacts whose forces nearly cancel do not blow s up.
///   From then on, t after it:   (F, T) += A s exp(-t/τ) sin(2π f t) (n, m),   (n, m) = (F, T)/|F, T| at the impact.
/// Coded as what each axis of the wrench has in common with every other, the impulse response of a resonator,
///   y_k+1 = 2 r cos φ y_k - r² y_k-1,   r = exp(-h/τ),  φ = 2π f h, h the tick;   an impact at k adds A s r sin φ to
///   y_k+1,
/// so that impacts that follow closely add up exactly and the state does not grow with their number.
/// Limit cases: s = 0 → nothing; no further impact → y falls below any limit, as r < 1.
/// Invariant: along any motion with |v| + R |ω| ≤ V an impact gives out at most A s V τ, the waveform's absolute
/// integral being less than A s τ; and s ≤ V. No impact: contact at the first sample of all or after rejected ones
/// (nothing is known of its speed), and contact that begins on a held tick. Rejected ticks end what rings.
///
/// Stage, only if the scene names the effect: after the contact's wrench, before its delay, so that the energy account,
/// the passivity controller and the output's limits see it as part of the wrench.
void renderTransients(const HandModel& model, const HandSample& hand, const ContactRecord& contacts,
                      const HandWrench& wrench, Ringing& ringing, TransientsShare& added) noexcept;
inline constexpr StageOf kTransients{
    renderTransients,
    {.name = "contact transients",
     .parameters = "effects.transients",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.hasTransients(); },
     .reason =
         [](const HandModel&) { return "effects.transients is set: a decaying vibration is added at every impact"; },
     .spared = [](const HandModel&) { return "effects.transients is not set"; }}};

}  // namespace passung::tick
