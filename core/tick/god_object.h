#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// The constraint-based method: the proxy goes where all contacts within reach let the hand draw it, and nothing else
/// moves it. Sources: Ortega, Redon and Coquillart (2007), Gauss's principle for a god object in six degrees of
/// freedom; Goldfarb and Idnani (1983) for the solution. Distance fields in place of their triangles, one thread in
/// place of their two, and the sweep below are ours.
///
/// Symbols: G proxy, H hand, P_i points of either part within reach of this tick's motion with φ_i and g_i = ∇φ (away
/// from the obstacle), r_i = P_i - o, o the held part's origin, s the finest cell, ρ = metric_radius, ρ² = K_φ/K.
///
/// Derivation. The coupling holds G by the energy E = ½K|x_H - x_G|² + ½K_φ|φ|². A body without mass, moved slowly, is
/// where E is least among the poses without overlap. For a small motion u = (Δx, ρ Δφ) of G towards
/// w = (x_H - x_G, ρ log(R_H R_Gᵀ)), E = ½K|u - w|² and φ_i changes by a_i · u, a_i = (g_i, (r_i × g_i)/ρ):
///   min ½|u - w|²   s.t.   a_i · u ≥ b_i,   b_i = -keep - φ_i,
/// strictly convex in six unknowns: one solution, found exactly (constrained_motion.h); with friction, friction.h. Its
/// multipliers λ_i ≥ 0 are the contact forces: the coupling's wrench K(w - u) = -K Σ λ_i a_i is what they push with.
///
/// Sweep. a_i is true to first order only. A step therefore goes no farther than is known around the proxy (`reach`,
/// more where free room is proven) and than half a cell, is looked at, and everything is set up anew from there, until
/// nothing is left that is allowed: at most kSweeps times. A step that ends with more than kRelieved is followed by
/// another, whose rows ask for it (b_i > 0).
///
/// Cuts. A step u' that ends with more overlap than kAccepted is taken back, and what it went into becomes a row too,
/// linearised where it was met:  φ' + a' · (u - u') ≥ b.  Beside a rim nothing else will do: the place of an edge that
/// is deepest after the step lay beside the obstacle before it, or so far along the edge that no row asked for it, and
/// the same step, halved or not, would be taken back tick after tick. After kCuts of them steps are halved.
///
/// Round a bend the way goes on in the next tick, unless it is fast: the straight line between two ticks' poses, which
/// is what others see of it, lies within kRelieved of it (proxy_way.h) and is as free as the way itself.
///
/// Cap. What a tick may look at is bounded (kFieldBudget). A step that does not fit is suspended, not dropped: the
/// proxy stays at the last pose that was accepted, with the cuts so far, and the next tick goes on from there
/// (kSuspended).
///
/// Budget of nodes (field_look.h). Under one a look may take several ticks; until it has ended the proxy stays at the
/// last pose that was accepted, so that what it is held by is never what nobody looked at. Then the step is made, or
/// cut, as if it had ended at once, and from there on it follows the hand of now. A way of several steps in one tick
/// does not bend: what looks between would prove, the next tick's step proves by its own.
///
/// Repair. A start in overlap is no special case: what is in overlap has to come to φ ≥ -max(keep, d - kRepair · s), d
/// the deepest overlap when the tick begins. The deepest points come out first, at kRepair · s a tick, so that the
/// coupling's force rises no faster than K times that; those between are not asked yet, because far inside what is
/// nearest may be the wrong side. Overlap that cannot be removed is only kept from growing (`relaxed`).
///
/// Limit cases: no contact within reach → G = H. One plane → G is H's projection onto it, at -keep. Two, three: H's
/// projection onto the edge, the corner. More than the body's freedom allows (a tight bore): the rest is held.
/// Invariants: no surface is passed. A point that is not known to be near is farther away than the step is long. One
/// that is near ends at φ ≥ -accept, or the step is taken back; for it to have come to the other side of an open sheet
/// (φ ≥ 0 again 2 cells farther on) it would have had to go farther than half a cell. Without friction the wrench is
/// Σ λ_i a_i, λ_i ≥ 0: nothing holds along a surface.
/// The three margins of overlap are less where kAccepted · s would be more than half the scene's tolerance.
/// What is not seen: on fields of cells of one size, an edge between two samples (elsewhere edge_search.h finds it);
/// `two_way` asks the other part's points and edges for it. Between the samples
/// an open sheet is still not passed if their cover radius is less than its offset, one cell.
inline constexpr double kKept = 0.002;      // overlap kept, per cell
inline constexpr double kRelieved = 0.006;  // overlap after a step that another one follows, per cell
inline constexpr double kAccepted = 0.02;   // overlap after a step that is taken back, per cell
inline constexpr double kRepair = 0.2;      // of overlap that was there before, per cell and tick
inline constexpr double kEnough = 0.002;    // of motion that is left after a step and not made, per cell
inline constexpr double kRest = 0.5;        // the same, per way made
inline constexpr int kSweeps = 16;
inline constexpr int kCuts = 4;  // of one step

/// Stage; those of proxy.h follow. rt-safe.
void sweepProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                const ObstaclePoses& obstacles, Proxy& proxy, ProxyMotion& motion, QueryMemory& memory, Pushes& pushes,
                Report& report) noexcept;
inline constexpr StageOf kProxySweep{
    sweepProxy,
    {.name = "proxy sweep",
     .parameters = "contact.method, stiffness_N_per_m, rotational_stiffness, mode, budget_nodes, two_way; friction",
     .cost = "at most 12 000 units of work a tick, about 0.5 ms; what is left goes on in the next tick",
     .needs =
         [](const HandModel& model) {
             return model.hasFieldProxyOf(scene::ContactMethod::GodObject) || model.hasNodeBudget();
         },
     .reason =
         [](const HandModel& model) {
             if (model.contact.method == scene::ContactMethod::GodObjectHeuristic)
                 return "contact.budget_nodes with god_object_heuristic: the proxy goes the way of god_object, which "
                        "can stop in a look and go on in the next tick";
             return model.contact.two_way
                        ? "contact.method is god_object: the proxy follows the hand as far as all contacts within "
                          "reach let it; contact.two_way: of the held part's points and of the obstacles' points"
                        : "contact.method is god_object: the proxy follows the hand as far as all contacts within "
                          "reach let it";
         },
     .spared = contactInstead}};

}  // namespace passung::tick
