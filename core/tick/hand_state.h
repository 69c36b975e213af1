#pragma once

#include <cstdint>
#include <span>

#include "core/tick/closed_form_proxy.h"
#include "core/tick/common_way.h"
#include "core/tick/contact_energy.h"
#include "core/tick/effect_sum.h"
#include "core/tick/energy_account.h"
#include "core/tick/followed_part.h"
#include "core/tick/god_object.h"
#include "core/tick/god_object_heuristic.h"
#include "core/tick/grip.h"
#include "core/tick/guidance.h"
#include "core/tick/hand_model.h"
#include "core/tick/inertia.h"
#include "core/tick/input_guard.h"
#include "core/tick/keep_apart.h"
#include "core/tick/navigation.h"
#include "core/tick/output_stage.h"
#include "core/tick/passivity.h"
#include "core/tick/penalty.h"
#include "core/tick/penalty_tool.h"
#include "core/tick/proxy.h"
#include "core/tick/proxy_state.h"
#include "core/tick/snap.h"
#include "core/tick/stage.h"
#include "core/tick/step.h"
#include "core/tick/surface_follow.h"
#include "core/tick/tick_frame.h"
#include "core/tick/transients.h"
#include "core/tick/virtual_coupling.h"
#include "core/tick/viscosity.h"
#include "core/tick/weight.h"

namespace passung::tick {

// The wholes, for those who walk the stages. No stage includes this header: from its parts no way leads to others.

/// Every stage that a scene may need, in the order of the tick.
using AllStages = StageList<kInputGuard, kEnergyAccount, kNavigation, kStartGate, kWeight,  // where the hand is
                            kFreeHand,                                                      // no contact
                            kContactsAtHand, kPenaltyWrench,                                // direct penalty
                            kPenaltyTool, kProxySweep,                                      // tool, god object
                            kProxyCorrection, kProxyMotion,                                 // its heuristic
                            kProxyFilter, kCommonWay, kProxyRecord, kHandDepth,             // what follows them
                            kClosedFormProxy, kClosedFormFilter, kClosedFormCommonWay,  // god objects on closed forms
                            kClosedFormRecord, kClosedFormDepth,                        // what follows them
                            kSurfaceProxy, kSurfaceRecord, kSurfaceDepth,               // the same on surfaces
                            kFollowedPart, kVirtualCoupling, kInertia,                  // their wrench
                            kHeldPushes, kContactSign, kTransients, kContactShares, kWeightInHand, kViscosity,
                            kGuidance, kSnap, kKeepApart, kEffectSum,             // effects
                            kClutchedWrench, kOutputDelay, kPassivityController,  // what goes out
                            kNoWrench, kOutputLimits>;

/// Everything of a hand that a tick carries to the next: the stages' own states. Sized by makeHandState; a tick never
/// allocates.
struct HandState : Parts<ObstaclePoses, HeldTarget, Grip, FollowedPart, InputGuard, HandMapping, Engagement,
                         EnergyAccounts, Proxy, ProxyMotion, ProxyFilter, ClosedFormHold, FilteredHold,
                         ClosedFormMemory, SurfaceFollow, HandVelocity, ToolMotion, Stretch, ContactSign, Hang, Moving,
                         Ringing, Stirring, Guiding, NearPairs, Pushes, DelayLine, SentWrench, QueryMemory> {};

/// What of it goes with the part: waits where nobody holds it.
struct PartState : Parts<ObstaclePoses, HeldTarget, Proxy, ProxyMotion, ProxyFilter, ClosedFormHold, FilteredHold,
                         ClosedFormMemory, SurfaceFollow, ToolMotion, Moving, QueryMemory> {};

/// The state before the first tick, with all memory that the ticks will need.
HandState makeHandState(const HandModel& model);

/// How a hand holds its part changes; the handle and the part stay where they are. All rt-safe.
/// The part is held at these points of it, by as many hands: its motions are measured by what draws it from now on.
/// `pulled`: as in motion::Metric::betweenHands.
void measureBy(const HandModel& model, std::span<const Vec3> held, HandState& hand, double pulled = 0.0) noexcept;
/// The part is at `X_DG` in the handle, and held at `p_GC`.
void regrip(const Pose& X_DG, const Vec3& p_GC, HandState& hand) noexcept;
/// All obstacles that move are where `X_WP` says, and rest there; what was known of them is void where they do not.
void placeObstacles(const HandModel& model, std::span<const Pose> X_WP, HandState& hand) noexcept;

/// Exchanges what goes with the part. rt-safe.
void swapParts(HandState& hand, PartState& part) noexcept;

/// Runs a stage on its parts. rt-safe.
template <const auto& stage>
void runStage(const HandModel& model, HandState& state, TickFrame& frame) noexcept {
    stage(model, state, frame);
}

}  // namespace passung::tick
