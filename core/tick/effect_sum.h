#pragma once

#include "core/tick/hand_model.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// The one place where effects come into the wrench, in this order: contact, transients, weight, viscosity, guidance,
/// snap, inertia, keeping apart.
/// Each is computed from what its own stage declares, and says what it adds in a part of the frame of its own; those
/// that the scene does not have add nothing, not even a zero. Records tell them where the scene asks for it, and always
/// that some of the force is there in the air too (kAidedInAir).
///   One more effect changes no bit of what another one adds, but navigation of all of them, by where the hand is, and
/// weight and inertia of transients, and weight of inertia, by where the proxy is. By what the stages declare
/// transients, weight and inertia might lead to others too, by pushes and proxy to the hand before its first sample;
/// viscosity, guidance, snap and keeping apart lead to none (effect_sum_test.cpp, all pairs).
///
/// Stage, of scenes with one of them: after all of them and the contacts' shares, before what fades, delays and limits.
void addEffects(const HandModel& model, const TransientsShare& transients, const WeightShare& weight,
                const ViscosityShare& viscosity, const GuidanceShare& guidance, const SnapShare& snap,
                const InertiaShare& inertia, const KeepApartShare& apart, HandWrench& wrench, EffectRecord& record,
                Report& report) noexcept;
inline constexpr StageOf kEffectSum{addEffects,
                                    {.name = "sum of effects",
                                     .parameters = "effects.record",
                                     .cost = "constant",
                                     .needs = [](const HandModel& model) { return model.wrenchEffects() != 0; },
                                     .reason = [](const HandModel&) { return "an effect adds to the wrench"; },
                                     .spared = [](const HandModel&) { return "no effect adds to the wrench"; }}};

}  // namespace passung::tick
