#pragma once

#include "core/motion/friction.h"
#include "core/tick/energy_account.h"
#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Energy per contact: the account of passivity.h, split over the pairs of the held part with each obstacle.
///
/// Symbols: o an obstacle, W_o = (F_o, T_o) the forces of its contacts on the held part about the held part's origin,
/// p_o ≥ 0 the sum of their sizes, W the wrench of the tick, K, K_φ the coupling's stiffness, ρ = metric_radius.
///   penalty       W_o is the obstacle's part of the sum that makes W (penalty.h).
///   god objects   W = K (w - u) = -K (Σ λ_i a_i + Σ_p B_pᵀ x_p) is held by the multipliers of the proxy's last motion
///                 (constrained_motion.h, friction.h), so that of its contacts i and patches p
///                 F_o = K Σ (λ_i g_i + x_p along the patch),
///                 T_o = K_φ/ρ² Σ (r_i × λ_i g_i + r_p × x_p + torsion) + r_c × F_o,   r from c, where the hand holds
///                 it.
/// What is more in W (dampers, vibration, what the linearisation misses) belongs to who presses:
///   W_o += p_o / Σ p · (W - Σ W_o).
/// What is sent differs from W by two factors, of force and torque (output_stage.h), and so do the shares; what is left
/// then (the passivity controller's damper, a coupling that lags in the air) belongs to no obstacle: the last account.
/// Each share is booked with the motion that the whole is booked with.
/// Invariant: the accounts add up to the whole, whatever method and effects there are. Limit cases: one obstacle in
/// contact has all; none: nobody has.

/// Forgets the pushes of the tick before. rt-safe.
void clearPushes(Pushes& pushes) noexcept;
/// Adds what a contact at `point` pushes the held part with, K times `along` [m]. rt-safe.
void addPush(const HandModel& model, const HeldTarget& target, const Pose& X_WG, const Vec3& point, const Vec3& along,
             double pressure, ObstaclePush& of) noexcept;
/// Adds what a patch rubs the held part with. rt-safe.
void addRub(const HandModel& model, const HeldTarget& target, const Pose& X_WG, const motion::FrictionPatch& patch,
            ObstaclePush& of) noexcept;
/// In place of the pushes so far: those of the contacts and patches that hold `motion` of the proxy. rt-safe.
void notePushes(const HandModel& model, const HeldTarget& target, const Proxy& proxy,
                const motion::ConstrainedMotion& motion, const motion::FrictionPatches& rubbing,
                Pushes& pushes) noexcept;

/// Stage, of scenes with obstacles: shares out what else is in F_H_W, and the vibration. After the wrench, before its
/// delay.
void sharePushes(const HandModel& model, const HandSample& hand, const Grip& grip, const HandWrench& wrench,
                 const TransientsShare& transients, Pushes& pushes) noexcept;
inline constexpr StageOf kContactShares{
    sharePushes,
    {.name = "contact shares",
     .parameters = "",
     .cost = "a little for each obstacle that pushes",
     .needs = [](const HandModel& model) { return model.hasObstacles(); },
     .reason = [](const HandModel&) { return "always: the energy account is kept for each obstacle too"; }}};

/// Stage, of hands with a proxy beside other hands: what their parts push the held part with (hand_balance.h).
void addHeldPushes(const HandModel& model, const HeldTarget& target, Pushes& pushes) noexcept;
inline constexpr StageOf kHeldPushes{
    addHeldPushes,
    {.name = "pushes between hands",
     .parameters = "",
     .cost = "a little for each obstacle that pushes",
     .needs = [](const HandModel& model) { return model.hasProxy() && model.meetsHands(); },
     .reason = [](const HandModel&) { return "parts in different hands may touch: what pushes them is accounted for"; },
     .spared =
         [](const HandModel& model) {
             return model.meetsHands() ? contactInstead(model) : "no other hand holds a part";
         }}};

/// Books what was sent since the good sample before over the handle's motion since then. rt-safe.
void bookPairs(EnergyAccounts& accounts, const Vec3& moved, const Vec3& turned, int ticks) noexcept;

}  // namespace passung::tick
