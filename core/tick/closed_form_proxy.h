#pragma once

#include <vector>

#include "core/closed_form/pose_solver.h"
#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// God objects on closed forms: the parts' own faces, edges and curvature in place of a distance field and points.
///
/// Derivation: pose_solver.h. Its energy is the coupling's: with ρ² = K_φ/K, ½K(|x_H - x|² + ρ²|φ|²). Its multipliers
/// λ_i are the contacts' forces: K λ_i along normal n_i, at point P_i. So a look of the solver is a sub-step of either
/// method, and what each of them builds on points is this here:
///   god_object            sweep: kMostLooks looks, each under all contacts within reach.
///   god_object_heuristic  #1 contacts at the last proxy; #2 relief of overlap, the deepest first, by kRepair a tick;
///                         #3 the way to the hand; #4 the motion that the contacts leave of it: kHeuristicLooks looks.
///   Either with threads: kThreadLooks. Where these rub, no look is begun after kMostRubs rows of friction.
/// Where the looks end before the proxy has come to rest it stays at the last pose without overlap, and goes on in the
/// next tick (kIterationLimit).
/// Limit cases: nothing within reach → G = H. A plane → G is H's projection onto it. A start in overlap: as there.
/// Invariants: overlap ≤ kKeptOverlap, but for what the scene began with. The wrench is Σ λ_i a_i, λ_i ≥ 0.
inline constexpr int kHeuristicLooks = 12;

/// What holds the proxy. Owner: closed-form proxy.
struct ClosedFormHold {
    closed_form::PoseMemory hold;
};

/// What holds the filtered proxy. Owner: closed-form filter.
struct FilteredHold {
    Pose X_WG_last;
    bool has_last_proxy = false;
    closed_form::PoseMemory hold;
};

/// Memory of searches: it saves time and changes no result. Handed on.
struct ClosedFormMemory {
    static constexpr bool kHandedOn = true;
    closed_form::PoseSolver solver{{}};
    std::vector<closed_form::ContactSearch> at_hand;
    geometry::NearList near_hand;
    closed_form::SearchMemory search;
    bool has_thread = false;
};

/// Memory for the model's pairs. `model` outlives it.
ClosedFormMemory closedFormMemory(const HandModel& model);

/// Stages, in this order. rt-safe.
void followInClosedForm(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                        const ObstaclePoses& obstacles, Proxy& proxy, ClosedFormHold& held, ClosedFormMemory& memory,
                        Pushes& pushes, Report& report) noexcept;
inline constexpr StageOf kClosedFormProxy{
    followInClosedForm,
    {.name = "closed-form proxy",
     .parameters = "contact.method, geometry, stiffness_N_per_m, rotational_stiffness",
     .cost = "a look at the faces and edges of near pairs and a motion under contacts for each sub-step, mostly two; "
             "bounds: "
             "kMostLooks, kHeuristicLooks, kMostMeetings",
     .needs = [](const HandModel& model) { return model.hasClosedForm(); },
     .reason =
         [](const HandModel& model) {
             return model.contact.method == scene::ContactMethod::GodObject
                        ? "contact.method is god_object and all pairs have a closed form: the proxy follows the hand "
                          "as far as the shapes' faces and edges let it; no distance field, no points"
                        : "contact.method is god_object_heuristic and all pairs have a closed form: steps #1 to #4 on "
                          "the shapes' faces and edges; no distance field, no points";
         },
     .spared = contactInstead}};

/// The low-pass of proxy.h. The proxy goes towards the filtered pose under the contacts, so that it costs no overlap.
void filterInClosedForm(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                        const ClosedFormHold& held, FilteredHold& filter, Proxy& proxy, ClosedFormMemory& memory,
                        Report& report) noexcept;
inline constexpr StageOf kClosedFormFilter{
    filterInClosedForm,
    {.name = "closed-form filter",
     .parameters = "contact.proxy_filter_hz",
     .cost = "in contact that of the closed-form proxy again",
     .needs = [](const HandModel& model) { return model.hasClosedForm() && model.contact.proxy_filter > 0.0; },
     .reason = [](const HandModel&) { return "contact.proxy_filter_hz is set: a low-pass of the proxy in contact"; }}};

/// Overlap, and the contacts that hold the proxy.
void describeClosedForm(const HandModel& model, const HeldTarget& target, const Proxy& proxy,
                        const ClosedFormHold& held, ContactRecord& record) noexcept;
inline constexpr StageOf kClosedFormRecord{
    describeClosedForm,
    {.name = "closed-form record",
     .parameters = "",
     .cost = "constant",
     .needs = [](const HandModel& model) { return model.hasClosedForm(); },
     .reason = [](const HandModel&) { return "overlap and contacts at the proxy, for the record"; }}};

/// The deepest overlap at the hand's pose: of faces with edges and cores, not of points.
void measureClosedFormDepth(const HandModel& model, const HandSample& hand, ClosedFormMemory& memory, HandDepth& depth,
                            Report& report) noexcept;
inline constexpr StageOf kClosedFormDepth{
    measureClosedFormDepth,
    {.name = "closed-form hand depth",
     .parameters = "contact.record_hand_depth",
     .cost = "a look at the faces and edges of near pairs",
     .needs = [](const HandModel& model) { return model.hasClosedForm() && model.record_hand_depth; },
     .reason = [](const HandModel&) { return "the overlap at the device's pose is measured and recorded"; }}};

}  // namespace passung::tick
