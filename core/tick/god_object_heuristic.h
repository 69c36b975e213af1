#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// The constraint-based method on top of the penalty query: the god object heuristic.
/// Source: Sagardia 2019, chapter 4, steps #1-#8, of which only the names and the order are at hand; what a step does
/// is reconstructed, and the deviations below are ours.
///
/// Symbols: G proxy, H hand, P_i contact points with φ_i and gradient g_i = ∇φ (out of the obstacle), r_i = P_i - o,
/// o the held part's origin, s the finest cell, ρ = metric_radius.
/// A small motion u = (Δx, ρ Δφ) of the proxy changes φ_i to first order by  a_i · u,  a_i = (g_i, (r_i × g_i) / ρ).
///
/// #1 contacts at the previous proxy G_{k-1}, not at the hand: that is what keeps the overlap small.
///    All points that this tick's motion could reach are taken (φ < reach), not only those inside: a constraint that
///    is known before it is violated cannot be jumped.
///
/// #2 correction of the previous proxy if its overlap p_max exceeds kAccept · s.
///    Rotation by θ about the penalty torque, the least squares of  θ h_i = p_i  over the contacts with a lever
///    h_i = n_i · (T̂ × r_i), and translation along the penalty force, shared by  λ = ‖F‖ / (‖F‖ + ‖T‖/ρ):
///    Δx = λ p_max F̂,  Δφ = (1 - λ) θ T̂.  Accepted only if the query at the corrected pose finds less overlap, else
///    halved; at most kCorrections times. No more than kLeave · s of the overlap is removed in a tick, here and again
///    in #4, so that a proxy that starts deep inside leaves without a kick.
///
/// #3 unconstrained motion  u = (x_H - x_G, ρ log(R_H R_Gᵀ)).
///
/// #4 constrained motion: the least change of u (Gauss) under  a_i · u ≥ -kKeep·s - φ_i,  see constrained_motion.h;
///    where parts rub on each other, held back by friction.h.
///    The step is no longer than what is known around the proxy: `reach`, or farther where free room is proven. It is
///    checked by a query. What the linearisation missed (around a rim) is pushed out by the least motion that the
///    contacts found there ask for; if the overlap is still not acceptable the step is halved; and all is repeated from
///    the new pose up to kSubSteps times; next to a surface that is about kSubSteps / 2 cells per tick, and a faster
///    hand leaves the proxy behind (kIterationLimit). Round a bend it goes on in the next tick (proxy_way.h). Under a
///    budget of nodes, a look of which may take several ticks, the sweep of god_object.h stands for #2 to #4.
///
/// #5 low-pass of the proxy, a stage of its own: filterProxy in proxy.h.
///
/// #6 coupling: virtual_coupling.h.
///
/// #7, #8 limits and sending: output_stage.h.
///
/// Why ρ² = K_φ / K: the proxy then minimises the coupling's energy  ½K|x_H - x_G|² + ½K_φ|φ|²  under the constraints.
/// At the minimum the coupling wrench is a sum of contact forces λ_i a_i, λ_i ≥ 0, so that no friction is felt that
/// nobody asked for. (With K_φ = 0, ρ is the shell's radius of gyration.)
/// Limit cases: no contact in reach → G = H. One plane → G is H's projection onto it; the overlap there is kKeep · s.
/// Invariants: between two ticks no point of the shell moves by more than it was known to be away from the obstacle
/// plus what was found at the next pose; overlap ≤ kAccept · s unless the scene started with more. Keeping kKeep · s of
/// overlap instead of none lets the record tell contact from nearness. Overlap is that of the shell's points with φ as
/// interpolated: at an obstacle's edges the field itself errs by more (DistanceField::errorBound), and an edge or
/// corner may stand between the points (point_shell.h, cover radius).
///   All three are less where kAccept · s would be more than the scene's tolerance.
inline constexpr double kKeep = 0.01;     // overlap kept, per cell
inline constexpr double kAccept = 0.05;   // overlap accepted by the test, per cell
inline constexpr double kRelieve = 0.02;  // overlap after a step that is pushed out again, per cell
inline constexpr double kLeave = 0.2;     // of a deeper overlap that a stage removes in a tick, per cell
inline constexpr int kReliefs = 2;
inline constexpr int kSubSteps = 12;
inline constexpr int kCorrections = 3;

/// Stages, in this order; those of proxy.h follow. First #1, #2.
void correctProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                  const ObstaclePoses& obstacles, Proxy& proxy, ProxyMotion& motion, QueryMemory& memory,
                  Pushes& pushes, Report& report) noexcept;
inline constexpr StageOf kProxyCorrection{
    correctProxy,
    {.name = "proxy correction",
     .parameters = "contact.method, mode, two_way",
     .cost = "nothing, or a few queries of each obstacle that is near; bound: kCorrections",
     .needs =
         [](const HandModel& model) {
             return model.hasFieldProxyOf(scene::ContactMethod::GodObjectHeuristic) && !model.hasNodeBudget();
         },
     .reason =
         [](const HandModel& model) {
             return model.contact.two_way
                        ? "contact.method is god_object_heuristic: steps #1 and #2, contacts at the last proxy "
                          "and relief of its overlap; contact.two_way: here and below of the held part's "
                          "points and of the obstacles' points"
                        : "contact.method is god_object_heuristic: steps #1 and #2, contacts at "
                          "the last proxy and relief of its overlap";
         },
     .spared = contactInstead}};

/// #3, #4.
void moveProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target, const ObstaclePoses& obstacles,
               Proxy& proxy, ProxyMotion& motion, QueryMemory& memory, Pushes& pushes, Report& report) noexcept;
inline constexpr StageOf kProxyMotion{
    moveProxy,
    {.name = "proxy motion",
     .parameters = "contact.stiffness_N_per_m, rotational_stiffness, mode, two_way; friction",
     .cost = "at most 12 000 units of work a tick, about 0.5 ms; what is left goes on in the next tick",
     .needs =
         [](const HandModel& model) {
             return model.hasFieldProxyOf(scene::ContactMethod::GodObjectHeuristic) && !model.hasNodeBudget();
         },
     .reason =
         [](const HandModel&) { return "steps #3 and #4: the proxy follows the hand as far as the contacts let it"; }}};

}  // namespace passung::tick
