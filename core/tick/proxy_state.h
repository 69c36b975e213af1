#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "core/contact/contact_query.h"
#include "core/contact/edge_search.h"
#include "core/motion/active_set.h"
#include "core/motion/friction.h"
#include "core/motion/metric.h"
#include "core/motion/pull.h"
#include "core/tick/energy_account.h"
#include "core/tick/lookout.h"

namespace passung::tick {

/// Where the obstacles are, in the order of HandModel::obstacles. Nobody writes it but step(), before the stages.
struct ObstaclePoses {
    static constexpr bool kOnlyRead = true;
    std::vector<Pose> X_WO;
    /// One that another hand holds, or has let go at the end of the last tick.
    struct Carried {
        std::uint32_t obstacle = 0;
        Pose X_WO_begin;     // when the tick began: some hands have had their turn since
        bool rests = false;  // it is not held any more
    };
    std::array<Carried, 2 * (scene::kMostHands - 1)> carried;  // the first `carried_count`
    std::size_t carried_count = 0;
    Pose X_WG_begin;  // of the held part, likewise

    std::span<const Carried> inHands() const noexcept { return {carried.data(), carried_count}; }
    /// Tells `near` where they are. rt-safe.
    void place(geometry::NearList& near) const noexcept {
        for (const Carried& in_hand : inHands()) {
            near.carry(in_hand.obstacle, X_WO[in_hand.obstacle]);
            if (in_hand.rests) near.rest(in_hand.obstacle);
        }
    }
};

/// Where the held part is asked to go, and what pushes it there beside its hand: the hand's pose, or where a part with
/// weight rests below it (weight.h), moves on (inertia.h) or is held by two, and nothing, but where it touches a part
/// in another hand (hand_balance.h). Nobody writes it but step(), before the stages that follow it.
struct HeldTarget {
    static constexpr bool kOnlyRead = true;
    Pose X_WT;
    motion::Metric metric;                // by which the way there is measured: where the hand holds the part
    int springs = 1;                      // of hands that draw it there: 2 where two hold it (pick.h)
    double stiffness = 1.0;               // of the pull against moving, over K: pull.stiffness()
    motion::Pull pull;                    // where it is more than one spring, and X_WT where it rests
    bool balanced = false;                // X_WT is where they balance with other hands' parts (hand_balance.h)
    FewOfMany<ObstaclePush> from_hands;   // of each obstacle, as Pushes; empty where no other hand is
    std::uint32_t contacts_of_hands = 0;  // that push so
    std::uint32_t work = 0;               // that the proxy's way may take in this tick, of what all hands have
    Pose X_WH_before;                     // the hand in the tick before, where there are several
    double others_way = 0.0;              // that the other hands went since then, together [m]

    /// True where one hand's spring does not say all.
    bool isPulled() const noexcept { return stiffness != 1.0; }
    /// What is to be followed in place of X_WT; null: X_WT.
    const motion::Pull* pullBeside() const noexcept { return isPulled() && !balanced ? &pull : nullptr; }
    /// The motion that is asked for with the part at `X`.
    motion::Motion wantedAt(const Pose& X) const noexcept {
        const motion::Pull* beside = pullBeside();
        return beside != nullptr ? beside->wantedAt(metric, X) : metric.between(X, X_WT);
    }
};

/// A look from a pose under a budget of nodes, and how far it has come (field_look.h).
struct FieldLook {
    bool open = false;  // it goes on in the next tick
    Pose X_WG;
    double reach = 0.0, search = 0.0;
    // When it has ended
    contact::ContactManifold found;
    double nearest = 0.0;          // least φ of the points that were looked at, as interpolated [m]
    double clearance_bound = 0.0;  // Proxy::clearance_bound
    // Where it stands
    double clearance = 0.0;
    bool proves = false, back = false, along_edges = false;
    std::vector<std::uint32_t> near;  // obstacles that it looks at, the first `near_count`
    std::size_t near_count = 0, at = 0;
    std::size_t first_of_obstacle = 0, first_of_way = 0;  // in what was found
    contact::QueryWorkspace workspace;
    contact::EdgePause edges;
};

/// A step whose end is still being looked at, and what it follows.
struct SuspendedStep {
    FieldLook look;
    motion::Motion u = motion::Motion::Zero();  // from Proxy::X_WG
    double share = 0.0;                         // of what was allowed
    bool halved = false;
    motion::FrictionPatches rubbing;
    Pose X_WT;           // where it was asked to go when it began
    Pose X_WT_followed;  // as far as steps that were made followed it
};

/// The held part where it is rendered, and what is known around it. Handed on among the stages of one method of
/// contact, of which a scene has one: free hand; contacts at the hand; penalty tool; proxy sweep, or correction and
/// motion; and the proxy filter.
struct Proxy {
    static constexpr bool kHandedOn = true;
    Pose X_WG;
    contact::ContactManifold manifold;  // at X_WG, points with φ < manifold_reach
    double manifold_reach = -1.0;       // < 0: nothing known
    double clearance = 0.0;             // least φ of the points that were looked at, as interpolated [m]
    double clearance_bound = 0.0;       // least φ known of any point: beyond the reach proven, spheres included [m]
    // Of a step that was suspended: contacts at the end of the manifold that it was cut by, and how often it was tried.
    std::size_t cuts = 0;
    int tried = 0;
    double lag = std::numeric_limits<double>::quiet_NaN();  // ContactRecord::proxy_lag
    std::vector<Pose> X_WO_known;  // where obstacles that move were when this was looked up; empty where none does
    SuspendedStep step;            // under a budget of nodes
};

/// Where contacts held the proxy's last motion: each is a point of the held part or of an obstacle.
struct ActivePoints {
    struct Point {
        Vec3 p_G, p_W;  // in the proxy, in the world
    };
    std::array<Point, 6> point;
    int count = 0;
};

/// What a god object's motion leaves for the next. Handed on from proxy correction to proxy motion, or owned by the
/// proxy sweep.
struct ProxyMotion {
    static constexpr bool kHandedOn = true;
    motion::FrictionPatches rubbing;  // of the last motion in contact
    ActivePoints held;                // of the last motion: where the solver of the next one begins
    double last_motion = 0.0;         // of the proxy, in the metric of then [m]
};

/// Memory of queries. Handed on, but what is in it is nobody's: each stage finds it in any state.
struct QueryMemory {
    static constexpr bool kHandedOn = true;
    contact::QueryWorkspace workspace;
    contact::ContactManifold scratch;
    Lookout around_proxy, around_hand;
};

}  // namespace passung::tick
