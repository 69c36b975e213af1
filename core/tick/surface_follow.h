#pragma once

#include <optional>

#include "core/surface/surface_proxy.h"
#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// God objects on surfaces: the parts' triangles never meet, because a small gap is held and proven.
///
/// Derivation: core/surface/surface_proxy.h. Its energy is the coupling's, with ρ² = K_φ/K, so that its rows' pushes λ
/// are the contacts' forces: K λ along a row's normal, at its point. Both methods go the way to the hand under the same
/// rows: god_object until the hand or the rows stop it, god_object_heuristic its steps #3 and #4 on them.
/// A budget bounds the work of a tick (kSurfaceBudget). What it leaves goes on in the next tick from the last accepted
/// pose: the proxy lags (kSuspended), nothing overlaps.
/// Limit cases: nothing near → G = H. A plane → G is H's projection onto it, one gap away.
/// Invariant: no triangle of the held part crosses one of an obstacle, at no pose of the way, but for what a start
/// overlaps, wholly or in part: that is left at 1 m/s (kLedOut).
inline constexpr int kSurfaceBudget = 38000;  // units of about 20 ns; of all hands together
inline constexpr double kSurfaceGap = 1e-6;   // [m]

/// Owner: surface proxy.
struct SurfaceFollow {
    std::optional<surface::SurfaceProxy> surface;
    double gap = 0.0;            // proven at the proxy [m]
    std::uint32_t contacts = 0;  // that hold it
};

/// Which body of the surface proxy an obstacle is that moves. rt-safe.
std::size_t surfaceBodyOf(const HandModel& model, std::uint32_t obstacle) noexcept;
/// Which obstacle a row is of. rt-safe.
std::size_t obstacleOf(const HandModel& model, const surface::SurfaceProxy& surface,
                       const surface::ContactRow& row) noexcept;

/// With what is near the start pose found out. `model` outlives it.
SurfaceFollow surfaceFollow(const HandModel& model);

/// Stages, in this order. rt-safe.
void followOnSurface(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                     const ObstaclePoses& obstacles, Proxy& proxy, SurfaceFollow& follow, Pushes& pushes,
                     Report& report) noexcept;
inline constexpr StageOf kSurfaceProxy{
    followOnSurface,
    {.name = "surface proxy",
     .parameters = "contact.method, geometry, stiffness_N_per_m, rotational_stiffness; friction",
     .cost = "at most 38 000 units of work a tick, about 0.7 ms; what is left goes on in the next tick",
     .needs = [](const HandModel& model) { return model.hasSurfaces(); },
     .reason =
         [](const HandModel& model) {
             return model.contact.method == scene::ContactMethod::GodObject
                        ? "contact.method is god_object and contact is that of surfaces: the proxy follows the hand as "
                          "far as no triangles meet; no distance field, no points"
                        : "contact.method is god_object_heuristic and contact is that of surfaces: the proxy follows "
                          "the hand as far as no triangles meet; no distance field, no points";
         },
     .spared = contactInstead}};

/// The proven gap, and the contacts that hold the proxy.
void describeSurface(const HandModel& model, const HeldTarget& target, const SurfaceFollow& follow,
                     ContactRecord& record) noexcept;
inline constexpr StageOf kSurfaceRecord{
    describeSurface,
    {.name = "surface record",
     .parameters = "",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.hasSurfaces(); },
     .reason = [](const HandModel&) { return "the proven gap and the contacts at the proxy, for the record"; }}};

/// How far the hand's pose lies beyond the contact that it presses most.
void measureSurfaceDepth(const HandModel& model, const HandSample& hand, const SurfaceFollow& follow,
                         HandDepth& depth) noexcept;
inline constexpr StageOf kSurfaceDepth{
    measureSurfaceDepth,
    {.name = "surface hand depth",
     .parameters = "contact.record_hand_depth",
     .cost = "a little for each contact that holds",
     .needs = [](const HandModel& model) { return model.hasSurfaces() && model.record_hand_depth; },
     .reason = [](const HandModel&) { return "the way from proxy to hand along what holds it is recorded"; }}};

}  // namespace passung::tick
