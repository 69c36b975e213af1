#pragma once

#include <span>

#include "core/contact/contact_query.h"
#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// How the hand moves, from sample to sample. Owner: penalty wrench.
struct HandVelocity {
    Pose X_WH_last;  // at the last new sample
    Twist V_H_last;  // measured there
    bool has_last_hand = false;
};

/// What is asked at the device's pose: the deepest point, on the surface between the samples too, and all points inside
/// obstacles, or where only their area-weighted sum matters that (QueryRequest::load). rt-safe.
contact::QueryRequest penaltyRequest(scene::PenaltyVariant variant) noexcept;

/// Stage: contact at the device's pose. Fills the manifold, or the load, by penaltyRequest. The proxy follows the
/// device: X_WG = X_WH.
void findContactsAtHand(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles, Proxy& proxy,
                        QueryMemory& memory, Pushes& pushes, AreaLoad& load, ContactRecord& record, HandDepth& depth,
                        Report& report) noexcept;
inline constexpr StageOf kContactsAtHand{
    findContactsAtHand,
    {.name = "contacts at the hand",
     .parameters = "contact.method, variant, mode, budget_nodes, two_way",
     .cost = "a query of each obstacle that is near, with two_way two",
     .needs = [](const HandModel& model) { return model.rendersAtHand(); },
     .reason =
         [](const HandModel& model) {
             return model.contact.two_way
                        ? "contact.method is penalty: forces come from the overlap at the device's own pose; "
                          "contact.two_way: of the held part's points and of the obstacles' points"
                        : "contact.method is penalty: forces come from the overlap at the device's own pose";
         },
     .spared = contactInstead}};

/// Penalty wrench of a manifold on the held part about `p_WO`, world axes (Sagardia 2019, 3.3; McNeely 1999). rt-safe.
///   p_i = max(0, -φ_i) depth, n_i the shell's inward normal, a_i area, r_i = P_i - O.
///   area_weighted   F = κ Σ a_i p_i n_i            T = Σ r_i × f_i
///   raw             F = K Σ p_i n_i                T = Σ r_i × f_i
///   max_normalised  as raw, scaled so that ‖F‖ = K p_max (one stiffness K, whatever the contact area).
/// Derivation of the first: on a half-space p is linear in space, so by the divergence theorem
///   F = κ ∫ p n dA = κ V n_plane, V the submerged volume, acting through its centroid, for any closed body;
/// the wet part of the plane itself adds nothing because p = 0 there.
/// Two-way contact: of the first two the mean of both ways, half the sum over all points; the third is taken over all
/// points of both ways as they are, so that ‖F‖ = K p_max holds whichever part has the deepest one.
/// Limit cases: no depth → zero wrench. Opposite contacts (a peg squeezed in a bore): Σ p_i n_i → 0 while p_max stays,
/// and the scale of max_normalised would grow without bound; it is therefore held at Σ p_i n_i ≥ kLeastCoherence · Σ
/// p_i (our addition), which lets the force fade to zero there.
/// `pushes`, if given, cleared, get each obstacle's part of it.
Wrench penaltyWrench(const scene::ContactSpec& contact, const contact::ContactManifold& manifold, const Vec3& p_WO,
                     FewOfMany<ObstaclePush>* pushes = nullptr) noexcept;
/// The same, and what each point has of it per depth, area-weighted per depth and area [N/m], [N/m³].
struct PenaltyLoad {
    Wrench wrench;
    double scale = 0.0;
};
PenaltyLoad penaltyLoad(const scene::ContactSpec& contact, const contact::ContactManifold& manifold, const Vec3& p_WO,
                        FewOfMany<ObstaclePush>* pushes = nullptr) noexcept;
/// The same for area_weighted, of QueryAnswer::load; `pushes`: each obstacle's load so far. rt-safe.
Wrench weightedWrench(const scene::ContactSpec& contact, const Wrench& load,
                      FewOfMany<ObstaclePush>* pushes = nullptr) noexcept;
inline constexpr double kLeastCoherence = 0.2;

/// Stage: the wrench of the manifold on the hand, with viscous damping along the force while in contact:
///   F += -b (v · F̂) F̂,  b = damping, v the hand's velocity; the same for the torque.
/// A damper may not pull: its part is limited so that F · F̂ stays ≥ 0.
/// v is the change from sample to sample over the time between them, so that a held tick, on which the hand only seems
/// to stand, keeps the last v and the next sample is not taken for twice as fast. After rejected ticks v starts from
/// zero: what lies between is no motion.
void renderPenalty(const HandModel& model, const HandSample& hand, const Proxy& proxy, const AreaLoad& load,
                   HandVelocity& velocity, Pushes& pushes, HandWrench& wrench) noexcept;
inline constexpr StageOf kPenaltyWrench{
    renderPenalty,
    {.name = "penalty wrench",
     .parameters = "contact.variant, stiffness_N_per_m, area_stiffness, damping, rotational_damping, two_way",
     .cost = "a little for each contact",
     .needs = [](const HandModel& model) { return model.rendersAtHand(); },
     .reason = [](const HandModel&) { return "turns the overlap into force and torque by contact.variant"; }}};

}  // namespace passung::tick
