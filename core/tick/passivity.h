#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/input_guard.h"
#include "core/tick/navigation.h"
#include "core/tick/output_stage.h"
#include "core/tick/tick_frame.h"
#include "core/tick/weight.h"

namespace passung::tick {

/// Energy that went into the controller through the device's handle, and a damper that takes back what the controller
/// gave too much.
/// Source: Hannaford and Ryu (2002), time domain passivity observer and controller; here in six degrees of freedom.
///
/// Symbols: Δx, Δφ how far the handle moved for certain from the good sample before to this one (see below); F̄, T̄ the
/// mean of the wrenches that were sent in between, each held for one tick; all about the handle's origin in the
/// device's base frame, so that neither scale nor registration enters, nor navigation.
///   E += -(F̄ · Δx + T̄ · Δφ)   [J]
/// That is exact where one wrench was held: what the controller has taken in since the trial began. A passive one keeps
/// E ≥ 0; what its springs hold counts as taken in and comes back. Rotation: with T̄ constant in base axes, exact to
/// second order in |Δφ|.
/// The motion is known in encoder steps q only: the handle is within q/2 of its reading in every coordinate. Believed
/// is the least motion that explains all readings, y_k = the place nearest to y_{k-1} within q/2 of reading k: a
/// reading that steps on and back crossed the same border twice, and a slow handle is where its reading steps, half a
/// step from both. (To book whole readings instead takes each press of a spring K by x and its release for K q x given
/// out, also where the motors did no work.) |y - true place| ≤ q, so that E is off by less than q Σ|F_k - F_{k-1}|: a
/// fast cycle may come out high by K q x. q = 0: the readings themselves. Limit cases: no motion or no wrench → E
/// stays. A held sample books nothing until the next new one comes. After rejected samples the way between is not known
/// and nothing is booked for it.
///
/// Weight: what lifting the part takes comes back with the part, whoever lets it down, and a trial may begin aloft. So
/// that is left out of E: E - U, U the part's energy in the air at the believed place y (liftEnergy), booked where the
/// weight was sent. E ≥ 0 then says the same of contacts, dampers and limits. Limit cases: a part that is lifted and
/// let down in the air → 0 throughout, but for what holding its torque for a tick gives out while it turns by ω, at
/// most ½ |τ| ω² τ_tick a second; a weight that the device's limits cut on the way up and not on the way down → less,
/// by what that gave out.
///
/// Stage, of every scene: E and the handle's velocity, from the sample and what was sent.
void observeEnergy(const HandModel& model, const InputGuard& guard, const HandSample& hand, const Grip& grip,
                   const HandMapping& mapping, const SentWrench& sent, EnergyAccounts& accounts,
                   EnergyRecord& record) noexcept;
inline constexpr StageOf kEnergyAccount{
    observeEnergy,
    {.name = "energy account",
     .parameters = "",
     .cost = "constant, and a little for each obstacle that pushes",
     .senses = true,
     .before_start = true,
     .needs = [](const HandModel&) { return true; },
     .reason =
         [](const HandModel&) {
             return "always: what the controller takes in and gives out at the handle is recorded";
         }}};

/// Stage, only if the scene names the effect: while E < 0, for one tick,
///   F += -α v,  T += -α ρ² ω,   α = min(-E / (τ (|v|² + ρ² |ω|²)), α_max)
/// which takes -E back if the handle goes on as it moves; v, ω from sample to sample, τ the tick, ρ = metric_radius,
/// α_max the scene's. Nothing at rest. After the wrench and its delay, before the output's limits, which may cut it.
void dampActivity(const HandModel& model, const HandSample& hand, const Grip& grip, const EnergyAccounts& accounts,
                  HandWrench& wrench, Report& report) noexcept;
inline constexpr StageOf kPassivityController{
    dampActivity,
    {.name = "passivity controller",
     .parameters = "effects.passivity_controller",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.effects.passivity_damping > 0.0; },
     .reason =
         [](const HandModel&) {
             return "effects.passivity_controller is set: a damper takes back energy that was given out";
         },
     .spared = [](const HandModel&) { return "effects.passivity_controller is not set"; }}};

}  // namespace passung::tick
