#pragma once

#include "core/motion/constrained_motion.h"
#include "core/tick/energy_account.h"
#include "core/tick/hand_model.h"
#include "core/tick/proxy_state.h"
#include "core/tick/tick_frame.h"

namespace passung::tick {

/// What the methods with a proxy (god object) share: what is known around it, how it may move, what is told of it.

inline constexpr double kLongestStep = 0.5;     // of a sub-step near an obstacle, per cell
inline constexpr double kShortestReach = 0.04;  // per cell: what is looked at even when nothing moves
inline constexpr double kReachGrowth = 2.0;     // over the last motion, so that a start from rest is not held back long
inline constexpr double kStill = 1e-8;          // [m]: a motion below this is none
inline constexpr int kHalvings = 4;
// Of looks at fields in a tick, of all hands, in units of about 45 ns: nodes, points, and contacts twice. No look is
// begun that would be expected to end beyond it, but for the first; the step goes on in the next tick (kSuspended).
inline constexpr std::uint32_t kFieldBudget = 12000;
inline constexpr std::uint32_t kLooksBetween = 4;  // that the looks between (cutsCorner) take together, at most

/// What the methods look at the proxy by.
struct ProxyView {
    const HandModel& model;
    Proxy& proxy;
    QueryMemory& memory;
    Report& report;
    const ObstaclePoses& obstacles;
};

/// What they move it by, towards the hand.
struct MovingProxy : ProxyView {
    const HandSample& hand;
    const HeldTarget& target;
    ProxyMotion& motion;
    Pushes& pushes;
};

/// Of the deepest point that was looked at [m], ≥ 0.
double overlap(const Proxy& proxy) noexcept;

/// True for a point inside an obstacle, false for one that is only near and for a sphere that stands in.
bool isInside(const contact::ContactPoint& contact) noexcept;

/// Puts the proxy at `X_WG` and looks around: all contacts within `reach`, and up to `search` [m] how far the nearest
/// one is if none is. Room beyond the reach is used without another look, so that it has to be proven. Where it
/// overlaps there, the scratch memory then holds what the manifold held before.
void queryAround(const ProxyView& view, const Pose& X_WG, double reach, double search) noexcept;

/// The same, under a budget of nodes perhaps in several ticks: begins a look, or goes on with the one that is open,
/// whatever is asked. False: it has not ended, and the proxy and what is known of it stay. rt-safe.
bool lookAround(const ProxyView& view, const Pose& X_WG, double reach, double search) noexcept;

/// After a look: where the obstacles that move were.
void noteObstacles(const ProxyView& view) noexcept;

/// What is known around the proxy, where parts in other hands have moved since it was looked up. Points of such a part
/// that are within d of the held part now have come nearer by no more than
///   |ΔX⁻¹ o - o| + |Δφ| (R + d),   o the proxy's origin, R the held part's reach, ΔX the part's motion:
/// by so much less is known, and less room is proven. Where one of its points was among the contacts, or so little is
/// left that a step could use it up, all of it is void.
void forgetMoved(const ProxyView& view) noexcept;

/// A place of the proxy, and what is known there but for the contacts.
struct ProxyPlace {
    Pose X_WG;
    double reach, clearance, clearance_bound;
    std::size_t cuts;
};
ProxyPlace placeOf(const Proxy& proxy) noexcept;

/// From where a look found overlap back to `place`, where the proxy was before it. Its contacts are those that the look
/// left in the scratch memory, which now holds what was met. rt-safe.
void takeBack(const ProxyView& view, const ProxyPlace& place) noexcept;

/// Work that a hand may still do in a tick on looks at fields, and whether it is enough for `looks` more like the last
/// one. Without any so far it always is: every tick gets on. rt-safe.
class LookBudget {
public:
    LookBudget(std::uint32_t most, const Report& report) noexcept
        : report_(report), most_(most), begun_(report.work), before_(report.work) {}
    /// A look begins.
    void begin() noexcept {
        before_ = report_.work;
        any_ = true;
    }
    bool allows(std::uint32_t looks = 1) const noexcept {
        return !any_ || report_.work - begun_ + looks * (report_.work - before_) <= most_;
    }

private:
    const Report& report_;
    std::uint32_t most_, begun_, before_;
    bool any_ = false;
};

/// True if a point overlaps by more than `accepted` [m] at the pose `share` of the way between two; the proxy and what
/// is known of it stay. rt-safe.
bool overlapsBetween(const ProxyView& view, const Pose& X_from, const Pose& X_to, double share,
                     double accepted) noexcept;

/// What is asked around the proxy when nothing is known of it yet: all contacts that any step could reach, and where
/// there is none the proof of it. rt-safe.
void surveyContacts(const ProxyView& view, const Pose& X_WG) noexcept;

/// Where the input guard believes the device to be elsewhere than it can have come from (a false first reading), the
/// proxy is set to the hand and its past forgotten: a spring from the old place would throw the hand across the room.
/// Looks around if nothing is known. False: still nothing is (lookAround).
bool startProxy(const MovingProxy& moving) noexcept;

/// How far around the proxy to look next, from how far it went in the last tick [m].
double nextReach(const HandModel& model, double last_motion) noexcept;

/// Takes the proxy straight to the hand, `path` away, through room that is proven to be free. False, and it stays, if
/// it would overlap there by more than `accepted`.
bool arriveFreely(const MovingProxy& moving, double path, double reach, double accepted) noexcept;

/// A step was made: `share` of all that `X_WT` asked for.
void noteFollowed(Proxy& proxy, const Pose& X_WT, double share) noexcept;

/// The tick's motion has ended; `arrived`: nothing is left of it. Notes what it lags behind.
void noteLag(const MovingProxy& moving, bool arrived) noexcept;

/// No point of the shell moves farther than this [m].
double longestPath(const MovingProxy& moving, const motion::Motion& u) noexcept;

motion::Surroundings surroundings(const MovingProxy& moving) noexcept;

/// What the contacts, and friction, leave of a motion. Begins with the contacts that held the one before.
struct AllowedMotion {
    motion::Motion u;
    motion::FrictionPatches rubbing;
};
AllowedMotion allowedMotion(const MovingProxy& moving, const motion::Motion& wanted,
                            const motion::Surroundings& around) noexcept;

/// Stage of a scene without obstacles: the held part is where the hand is, or goes on by itself (inertia.h).
void followHand(const HandModel& model, const HandSample& hand, const HeldTarget& target, Proxy& proxy) noexcept;
inline constexpr StageOf kFreeHand{followHand,
                                   {.name = "free hand",
                                    .parameters = "",
                                    .cost = "constant",
                                    .needs = [](const HandModel& model) { return !model.hasObstacles(); },
                                    .reason =
                                        [](const HandModel& model) {
                                            return model.hasPart() ? "the scene has no obstacle"
                                                                   : "the hand holds nothing";
                                        }}};

// Stages that follow the proxy's motion.

/// Owner: proxy filter.
struct ProxyFilter {
    Pose X_WG_last;
    bool has_last_proxy = false;
};

/// Low-pass (only if the scene names its corner f_c), while in contact:
///   G_k = G_{k-1} ⊕ α (G* ⊖ G_{k-1}),  α = 1 - exp(-2π f_c T); dropped for a tick where it would cost overlap, or
/// more nodes than a budget leaves.
void filterProxy(const HandModel& model, const HandSample& hand, const HeldTarget& target,
                 const ObstaclePoses& obstacles, ProxyFilter& filter, Proxy& proxy, QueryMemory& memory,
                 Report& report) noexcept;
inline constexpr StageOf kProxyFilter{
    filterProxy,
    {.name = "proxy filter",
     .parameters = "contact.proxy_filter_hz",
     .cost = "in contact one query of each obstacle that is near, at most two",
     .needs =
         [](const HandModel& model) {
             return model.hasFieldProxy() && model.contact.proxy_filter > 0.0 &&
                    model.contact.method != scene::ContactMethod::Penalty;
         },
     .reason = [](const HandModel&) { return "contact.proxy_filter_hz is set: a low-pass of the proxy in contact"; },
     .spared =
         [](const HandModel& model) {
             return model.contact.proxy_filter > 0.0 ? contactInstead(model) : "contact.proxy_filter_hz is 0";
         }}};

/// The depth, the number of contacts and the lag, for the record.
void describeProxy(const HandModel& model, const Proxy& proxy, ContactRecord& record) noexcept;
inline constexpr StageOf kProxyRecord{
    describeProxy,
    {.name = "proxy record",
     .parameters = "",
     .cost = "a little for each contact",
     .needs = [](const HandModel& model) { return model.hasFieldProxy(); },
     .reason = [](const HandModel&) { return "overlap and contacts at the proxy, and its lag, for the record"; }}};

/// Depth of the held part at the hand's pose: only for the record, an extra query.
void measureHandDepth(const HandModel& model, const HandSample& hand, const ObstaclePoses& obstacles,
                      QueryMemory& memory, HandDepth& depth, Report& report) noexcept;
inline constexpr StageOf kHandDepth{
    measureHandDepth,
    {.name = "hand depth",
     .parameters = "contact.record_hand_depth",
     .cost = "a query of each obstacle that is near, with two_way two",
     .needs = [](const HandModel& model) { return model.hasFieldProxy() && model.record_hand_depth; },
     .reason = [](const HandModel&) { return "the overlap at the device's pose is measured and recorded"; }}};

}  // namespace passung::tick
