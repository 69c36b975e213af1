#pragma once

#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"
#include "core/tick/weight.h"

namespace passung::tick {

/// Owner: virtual coupling.
struct Stretch {
    Vec3 last_stretch = Vec3::Zero(), last_twist = Vec3::Zero();  // at the last new sample
    Vec3 last_stretch_rate = Vec3::Zero(), last_twist_rate = Vec3::Zero();
    bool has_last_stretch = false;
};

/// Stage: a spring and damper between the proxy and the hand (Colgate 1995); steps #6 of the god object.
///   e = c_G - c_H,  ψ = log(R_WG R_WHᵀ)
///   F = K e + B ė,   T = K_φ ψ + B_φ ψ̇,
/// c the point of the part that the hand holds (grip.h), T about c_H: about the part's origin there it is r_c × F more.
/// ė and ψ̇ are the changes from sample to sample over the time between them. On a held tick the last rates hold as a
/// whole: the proxy's motion answers the hand's, so that the hand's part alone would leave -v_H, a brake in free
/// motion. Springs go on with the present stretch (a proxy that lags may catch up meanwhile). After rejected ticks the
/// rates start from zero: what lies between is no motion. The damper acts on the stretch, not on the hand's speed: in
/// free motion e = 0 and there is no load, and along a frictionless surface e does not change, so that sliding is not
/// braked. It may not pull the hand into the surface it leaves: where the damper would turn F against e (T against ψ),
/// that part is dropped. Limit cases: a proxy at rest gives ė = -v_H, the usual wall damper; e = 0 gives F = 0, also in
/// the tick after contact. A part with weight (weight.h): from where it would rest in the air, R in place of H; it
/// hangs there without a load of this stage. One with inertia: the damper acts on the part too, and nothing of it is
/// dropped; what contacts do not hold is inertia's (inertia.h).
void renderCoupling(const HandModel& model, const HandSample& hand, const Grip& grip, const Proxy& proxy,
                    const Hang& hang, Stretch& stretch, HandWrench& wrench) noexcept;
inline constexpr StageOf kVirtualCoupling{
    renderCoupling,
    {.name = "virtual coupling",
     .parameters = "contact.stiffness_N_per_m, rotational_stiffness, damping, rotational_damping",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.hasCoupling(); },
     .reason = [](const HandModel&) { return "spring and damper between proxy and hand"; }}};

}  // namespace passung::tick
