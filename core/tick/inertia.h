#pragma once

#include <span>

#include "core/motion/pull.h"
#include "core/tick/energy_account.h"
#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"
#include "core/tick/virtual_coupling.h"

namespace passung::tick {

/// Inertia of the held part: what it takes to shake it, and that it goes on where nothing stops it.
///
/// Symbols: m mass, I moments about the centre of mass m_G, T the tick, K, B and K_φ, B_φ the coupling's stiffness and
/// damping, H hand, R where the part hangs from it (weight.h; H without weight), G proxy, e = c_G - c_R and φ the
/// coupling's stretch, e⁻, φ⁻ those of the sample before, A where the part would be after this tick at the speed that
/// it has: its centre of mass and it go on by what they went in the tick before.
///   min  ½K|e|² + ½K_φ|φ|² + ½B/T |e - e⁻|² + ½B_φ/T |φ - φ⁻|² + ½m/T² |m_A - m_G|² + ½ψ · R_A I R_Aᵀ/T² ψ
/// as far as contacts let it: Newton's law m (v - v⁻)/T = F by the implicit Euler rule, with a damper between hand and
/// part (motion/pull.h; spring and damper at one point are one spring, of K + B/T from where e is B/T/(K + B/T) e⁻).
/// Each method of contact goes to where that is least in place of going to the hand, and knows of no mass. The hand
/// feels the coupling, K e + B ė. What of that no contact holds is inertia's: m_A - m_G times m/T², but for what a tick
/// leaves unsettled.
///
/// Limit cases: hand at rest → the part comes to rest there, and F = 0. A hand that accelerates at a, for long → F =
/// -m a, by m a/K behind. A part that meets a wall stops there without a bounce: its momentum is gone in that tick.
/// Scale 0 → no stage, every bit as without. Against a wall at rest: the contact alone.
/// Invariant: the implicit Euler rule only takes energy from part and coupling; what comes back of ½mv² is what the
/// hand put in.
/// In two hands (pick.h) the part has one momentum, and each hand feels its own coupling, inertia included, which is
/// told as contact's. A hand that lets go leaves it to the other. Who picks a part up takes it at rest, and so is what
/// is let go. Where a capped tick or another hand's part makes the proxy wait, the momentum is gone, as at a wall.
/// Stability: that of a tool with a mass (core/loop/stability.h), whose contact is rigid or none.

/// Owner: inertia. Goes with the part.
struct Moving {
    Pose X_WG_before;  // the proxy at the end of the tick before
    Twist on;          // how far its centre of mass went in that tick [m], and it turned [rad]
    bool has_before = false;
};

/// What keeps a part moving that is at `X_WG`. @pre model.hasInertia(). rt-safe.
motion::Momentum momentumOf(const HandModel& model, const Moving& moving, const Pose& X_WG) noexcept;

/// What pulls it, held at `held` by one hand or two, but for where these are. @pre model.hasInertia(). rt-safe.
motion::Pull pullOf(const HandModel& model, std::span<const Vec3> held, const motion::Momentum& momentum) noexcept;

/// Where a hand's spring and damper together draw the part to that is at `X_WG`, the spring alone to `X_WR`. rt-safe.
Pose drawnTo(const HandModel& model, const Stretch& stretch, const Vec3& p_GC, const Pose& X_WR,
             const Pose& X_WG) noexcept;

/// Stage, after the coupling: what of it no contact holds, and how the part moves. Where two hands hold it nothing is
/// told apart.
void tellInertia(const HandModel& model, const HandSample& hand, const Grip& grip, const HeldTarget& target,
                 const Proxy& proxy, const Pushes& pushes, Moving& moving, HandWrench& wrench,
                 InertiaShare& added) noexcept;
inline constexpr StageOf kInertia{
    tellInertia,
    {.name = "inertia",
     .parameters = "effects.inertia, part.density_kg_per_m3, contact.stiffness_N_per_m, damping, rotational_stiffness, "
                   "rotational_damping",
     .cost = "constant, and in contact some looks more at what is near",
     .needs = [](const HandModel& model) { return model.hasInertia(); },
     .reason = [](const HandModel&) { return "effects.inertia is set: the proxy is a mass on the coupling's spring"; },
     .spared =
         [](const HandModel& model) {
             return model.effects.inertia.any() ? "the hand holds nothing that has a density, or another hand moves it"
                                                : "effects.inertia is not set, or its scale is 0";
         }}};

}  // namespace passung::tick
