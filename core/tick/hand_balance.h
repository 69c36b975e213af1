#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/motion/active_set.h"
#include "core/scene/scene_spec.h"
#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"

namespace passung::tick {

/// Contacts between parts in different hands: how each pushes the other.
///
/// Why. Hands take turns: a proxy goes to the pose nearest to its hand that all other parts leave, and these rest
/// meanwhile, so that no part ever passes another. Alone that would make a wall of a part in another hand: whom it is
/// pushed against feels it, who holds it does not. So before the turns each hand is given the pose where all springs
/// and all contacts together balance, and its proxy goes there in place of going to the hand. (Own.)
/// A part with weight goes to where it would rest in the air (weight.h); that is its hand's pose below, and its weight
/// is in what it pushes others with.
///
/// Symbols: h a hand, H_h and G_h its pose and its proxy, K the coupling's stiffness, which all hands share; u_h the
/// motion of G_h that is looked for, w_h the way from G_h to H_h, both in the hand's metric (motion/metric.h: c_h,
/// S_h), of a part in two hands times √2, as K counts twice there, and of one with inertia by the root of its
/// stiffness; i a contact of the part in hand h at point P_i with normal n_i away from the obstacle and room g_i to go
/// before it holds; r_ih = P_i - c_h.
///   min Σ_h ½K |u_h - w_h|²   s.t.   a_ih · u_h - a_ij · u_j ≥ -g_i,   a_ih = (n_i, S_h⁻¹ r_ih × n_i),
/// the second term only where the obstacle is in hand j: strictly convex in six unknowns a hand, solved exactly
/// (active_set.h). Its multipliers λ_i ≥ 0 are the contacts' forces K λ_i n_i, on one part and against the other.
/// The contacts are those that each proxy's own search left in its last turn, the first kMostBalanced. What none of
/// them knows, a proxy's own sweep finds: then it stops there, and the next tick's balance knows it. Where contacts
/// leave no common motion, g_i becomes max(0, g_i): u = 0 obeys that.
///
/// Turns: who gives way goes first, so that the other need not wait for the next tick.
///
/// Limit cases: one hand, or hands whose parts do not press each other → the target is the hand itself, and every bit
/// is that of the hand alone. Two springs of the same stiffness pressed together by d → both parts give way by d/2, and
/// each hand feels K d/2. A part pressed against one that lies on a wall → as against the wall.
/// Invariant: the forces that parts in hands push each other with are equal and opposite.
/// Without proxies (penalty, at the hand or by a tool) each hand feels the overlap itself: nothing is to be balanced.
struct BalancedContact {
    motion::MotionRowOf<motion::kMostUnknowns> row;
    Vec3 point, normal;           // world
    std::size_t hand = 0;         // whose search found it
    std::uint32_t obstacle = 0;   // of that hand
    std::size_t other = kNobody;  // hand that holds the obstacle
    static constexpr std::size_t kNobody = ~std::size_t{0};
};

/// Memory of the balance. Nothing in it lasts from one tick to the next.
struct BalanceMemory {
    std::vector<BalancedContact> contacts;  // kMostBalanced, or none where no balance is needed
    std::size_t count = 0;
};
inline constexpr std::size_t kMostBalanced = 512;

struct HandState;
struct TickModel;

/// A hand of a tick: its model with what it holds, and its state.
struct HandInTick {
    const HandModel* model = nullptr;
    HandState* state = nullptr;
};

/// The order of the hands' turns in a tick.
using Turns = std::array<std::size_t, scene::kMostHands>;

/// Sets each hand's HeldTarget from where the hands are, with what hangs from them, and says in which order they go:
/// `first` and those after it, but for who gives way. rt-safe.
Turns balanceHands(std::span<const HandInTick> hands, std::span<const Pose> X_WH, std::size_t first,
                   BalanceMemory& memory) noexcept;

/// Memory for the balance of a scene's hands.
BalanceMemory balanceMemory(const TickModel& model);

}  // namespace passung::tick
