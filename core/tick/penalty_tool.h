#pragma once

#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// Owner: penalty tool. Where the tool is, is the proxy.
struct ToolMotion {
    motion::Motion last = motion::Motion::Zero();  // U⁻ below; zero where contacts held the tool back [m]
    double last_way = 0.0;                         // |U⁻|, however it ended [m]
    Pose X_WH_last;                                // at the last tick
    bool has_last_hand = false;
};

/// The penalty through a coupling: forces come from the overlap of a tool, which a spring holds to the hand. What the
/// hand feels is that spring (virtual_coupling.h), so that nothing stiffer than it is ever displayed, whatever the
/// contacts add up to. Sources: McNeely, Puterbaugh and Troy (1999), Colgate (1995) for the virtual coupling; Wan and
/// McNeely (2003) for the quasi-static one. Whole steps with an acceptance test in place of one linear solution a tick,
/// and the limits below, are ours.
///
/// Symbols: G tool, H hand, K, K_φ the coupling's stiffness, ρ² = K_φ/K (ρ = metric_radius), P_i points of the shell
/// with depth d_i = -φ_i and g_i = ∇φ, r_i = P_i - o, o the held part's origin, c the penalty wrench at G (penalty.h,
/// with contact.penalty_stiffness), T the tick.
///   w = (x_H - x_G, ρ log(R_H R_Gᵀ))     what the spring asks of the tool: its wrench on it is K w
///   p = (c_F, c_T/ρ) / K                 what the contacts ask of it
///   U, U⁻                                the tool's motion in this tick, in the one before; h the hand's motion
///   quasi_static  0 = w + p              a tool without mass is where spring and contacts balance
///   virtual       0 = w + p + B/(K T) (h - U) + m/(K T²) (U⁻ - U)
/// The second is Newton's law m (v - v⁻)/T = F by the implicit Euler rule with the coupling's damper B; for rotations
/// with B_φ and the inertia I, each over ρ². The inertia is a ball's (no gyroscopic torque). Both are one equation
/// q(G) = 0, with D = 1 + B/(K T) + m/(K T²) ≥ 1 times a motion u of the tool taken away from q by all but contacts.
///
/// Step: u from the linearised contacts, each a spring σ_i = k_i/K that only pushes, k_i its share of the penalty:
///   min ½ uᵀ D u - q·u + ½ Σ σ_i (max(0, d_i - a_i·u)² - max(0, d_i)² + 2 max(0, d_i) a_i·u),  a_i = (g_i, r_i×g_i/ρ)
/// strictly convex in six unknowns; at u = 0 its slope is -q exactly, though penalties push along the shell's normals
/// and not along g_i. Solved by Newton's method on the set of points inside, (D + Σ σ_i a_i a_iᵀ) u = q + ...: the 6 ×
/// 6 system of the quasi-static coupling, points near the tool included. A step goes no farther than half a cell beyond
/// what is free around the tool, and is taken only if |q/D| falls; else it is halved. What is not settled after
/// kToolSteps goes on in the next tick (`kIterationLimit`): the tool stays where it is, and with it a spring that is
/// only as long as the hand is away. What pushes the tool away from the hand does so by at most kRepair (god_object.h)
/// of a cell in a tick, so that a tool that starts in deep overlap leaves it without a kick; it then has no speed.
///
/// A tool with weight (weight.h): w leads to where it would rest in the air. Its mass is tool_mass_kg, whatever it
/// weighs.
///
/// Limit cases: no contact → G = H (quasi-static); a mass on a spring and damper behind the hand (virtual). A plane of
/// stiffness k → the hand feels K k/(K + k). k → ∞ → the god object. K → ∞ → the direct penalty.
/// Invariants: force on the hand ≤ K times the stretch plus damping. Quasi-static: the tool is where E = ½K|w|² + E_c
/// is least nearby; where contacts have an energy E_c, a closed slow path costs none. Virtual: implicit Euler only
/// takes energy from tool and springs. Not seen: as with the direct penalty, a thin part can be passed.
inline constexpr int kToolSteps = 8;
inline constexpr double kSettled = 1e-8;  // [m], of q/D

/// Stage. proxy.h's record and virtual_coupling.h follow. rt-safe.
void settleTool(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                const ObstaclePoses& obstacles, Proxy& proxy, ToolMotion& tool, QueryMemory& memory, Pushes& pushes,
                Report& report) noexcept;
inline constexpr StageOf kPenaltyTool{
    settleTool,
    {.name = "penalty tool",
     .parameters = "contact.coupling, variant, penalty_stiffness_N_per_m, tool_mass_kg, tool_inertia_kg_m2, stiffness, "
                   "damping, mode, budget_nodes, two_way",
     .cost = "a few queries of each obstacle that is near; bound: kToolSteps",
     .needs = [](const HandModel& model) { return model.hasFieldProxyOf(scene::ContactMethod::Penalty); },
     .reason =
         [](const HandModel& model) {
             return model.contact.coupling == scene::PenaltyCoupling::Virtual
                        ? "contact.coupling is virtual: a tool with mass between the hand's spring and the "
                          "contacts' penalty"
                        : "contact.coupling is quasi_static: a tool where the hand's spring and the contacts' "
                          "penalty balance";
         },
     .spared = [](const HandModel&) { return "contact.coupling is direct"; }}};

}  // namespace passung::tick
