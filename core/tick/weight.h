#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/grip.h"
#include "core/tick/hand_model.h"
#include "core/tick/input_guard.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Where the held part would rest in the air. Owner: weight.
struct Hang {
    Pose X_WR;
};

/// Weight of the held part.
///
/// Why it is no force on the hand: one that is added to the coupling's wrench pulls also while the part lies on a
/// table. It pulls at the part: the proxy goes to where its spring carries it, and lies where something else does.
///
/// Symbols: m mass, g gravity, c the centre of mass in the part, seen from the point x that the hand holds (grip.h), H
/// hand, G proxy, K, K_φ the coupling's stiffness.
///   f = m g,   τ = (R_H c) × f                 the weight about x
///   x_R = x_H + f/K,   R_R = exp(τ/K_φ) R_H    where the proxy rests in the air
/// Derivation: a body without inertia is where ½K|x_H - x|² + ½K_φ|φ|² - f · x - τ · φ is least, φ from H; but for a
/// constant that is ½K|x_R - x|² + ½K_φ|φ_R|², φ_R from R, the turns' products aside. So each method of contact goes to
/// R in place of H, and knows of no weight. What the hand feels is the spring,
///   F = K (x_G - x_H),   T = K_φ log(R_G R_Hᵀ),
/// coded as the contacts' share, from G to R, which is all that dampers, transients and the accounts of obstacles see
/// (virtual_coupling.h), and what is left, which the second stage adds.
///
/// Limit cases: in the air G = R: F = f and T = τ, exactly, as exp and log undo each other up to half a turn
/// (scene::kMostHangingTurn). On a table: 0 where the hand is as low as the part, f again where it is f/K above,
/// between them what is left of f. Pressed down: the contact alone. K_φ = 0: F alone; nothing shows a torque. Without a
/// proxy (penalty at the hand, no obstacle) the grip is rigid: R = H, the weight is added as it is, and a contact's own
/// springs carry it: |f|/K of overlap do.
/// A penalty's tool: between hand and contact in the ratio of their springs; F is as exact as the tool settles.
/// On a part in another hand: as on a table, and felt there (hand_balance.h).
/// A hand closes on no part that would hang from it turned by more than kMostHangingTurn (pick.h).
/// Arm: that of the part in the hand, R_H c, not R_G c: what hangs turns by |τ|/K_φ, and would carry the felt torque
/// with it. So the wrench in the air follows from the hand's pose alone and has a potential, -f · (x_H + R_H c).
/// Not conserved: where a contact turns the part by ψ against the hand, τ is off by up to |f||c||ψ|, and a closed way
/// of the part's turn α may give or take |f||c||ψ| α.
///
/// In two hands (motion::Pull): the springs' rest pose is that of both with the weight, and each hand feels what
/// its own spring holds; together they hold m g. What of it is weight is what its force has along m g, within 0 ... 1
/// times that: so much of lifting each hand's account leaves out, and no obstacle has (borneWeight).
///
/// Stability: against turning, the weight is a spring of at most |f||c| a radian, which is no more than K_φ; against
/// moving it is none.
///
/// Inertia: an effect of its own (inertia.h). Without it a hand that shakes the part feels its weight and no more.

/// What gravity does to the part at this orientation of it: about its origin, world axes. rt-safe.
Wrench weightOf(const HandModel& model, const Quat& R_WG) noexcept;

/// What the device shows of the part's weight: a force, and where it acts. rt-safe.
Hanging hangingOf(const HandModel& model, const Grip& grip) noexcept;

/// Work that lifting the part from the device's origin to where the handle is at `X_BD` takes, of that, up to a
/// constant [J]. Of the handle's motion: the registration's scale does not enter. rt-safe.
double liftEnergy(const Hanging& hanging, const Pose& X_BD) noexcept;

/// Of the wrench on a hand that holds the part with another one, what is the part's weight: about the part's origin,
/// world axes. rt-safe.
Wrench borneWeight(const HandModel& model, const HandSample& hand, const Grip& grip, const Wrench& F_H_W) noexcept;
/// Turns the part hangs by from a hand that holds it there [rad]; 0 where nothing hangs. rt-safe.
double hangingTurn(const HandModel& model, const Vec3& p_GC) noexcept;

/// Stages. The first finds R. Before there is a good sample the hand is where the proxy is (input_guard.h), and so is
/// R.
void hangPart(const HandModel& model, const HandSample& hand, const Grip& grip, const InputGuard& guard,
              Hang& hang) noexcept;
inline constexpr StageOf kWeight{
    hangPart,
    {.name = "weight",
     .parameters = "effects.weight, part.density_kg_per_m3, contact.stiffness_N_per_m, rotational_stiffness",
     .cost = "constant",
     .senses = true,
     .before_start = true,
     .needs = [](const HandModel& model) { return model.hasWeight(); },
     .reason =
         [](const HandModel& model) {
             return model.hasProxy()
                        ? "effects.weight is set: the proxy hangs from the hand as far as its weight "
                          "stretches the coupling"
                        : "effects.weight is set: no proxy hangs from the hand, which holds the part itself";
         },
     .spared = [](const HandModel&) { return "effects.weight is not set, or the held part has no density"; }}};

/// After all that is told of contacts. Its share of the wrench is noted as a push of no obstacle, and the record
/// tells that it is there (kWeighed). Where two hands hold the part their springs do, and nothing is added.
void addWeight(const HandModel& model, const HandSample& hand, const Grip& grip, const Proxy& proxy, const Hang& hang,
               const HandWrench& wrench, Pushes& pushes, WeightShare& added, Report& report) noexcept;
inline constexpr StageOf kWeightInHand{
    addWeight,
    {.name = "weight in the hand",
     .parameters = "effects.weight, part.density_kg_per_m3",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.hasWeight(); },
     .reason = [](const HandModel&) { return "effects.weight is set: what no contact carries is felt"; }}};

}  // namespace passung::tick
