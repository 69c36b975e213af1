#include "core/tick/common_way.h"

#include <algorithm>
#include <cmath>

#include "core/tick/obstacle_query.h"

namespace passung::tick {

namespace {

Pose between(const Pose& from, const Pose& to, double share) noexcept {
    return {from.q.slerp(share, to.q), from.p + share * (to.p - from.p)};
}

/// How a part goes: no point within `radius` of its origin farther than `way` [m].
struct Going {
    Going(const Pose& from, const Pose& to, double radius) noexcept
        : turn(rotationVector(to.q * from.q.conjugate()).norm()), way((to.p - from.p).norm() + turn * radius) {}
    double turn, way;  // [rad], [m]
};

/// The ways of the held part to `X_WG` and of a part in another hand, seen as
/// points of the held part go: those of the other part are near them where they could meet.
struct CommonWay {
    CommonWay(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WG,
              const ObstaclePoses::Carried& in_hand) noexcept
        : last(in_hand.X_WO_begin),
          now(obstacles.X_WO[in_hand.obstacle]),
          carried(now * last.inverse() * obstacles.X_WG_begin),
          own(obstacles.X_WG_begin, X_WG, model.reach),
          other(obstacles.X_WG_begin, carried, model.reach),
          relative(carried, X_WG, model.reach) {
        const double apart =
            (now.p - X_WG.p).norm() - model.reach - model.bodies[model.obstacles[in_hand.obstacle].body].reach;
        far = apart > own.way + other.way;
    }

    /// The least of the three ways; 0 where the parts cannot have met [m].
    double least() const noexcept { return far ? 0.0 : std::min({own.way, other.way, relative.way}); }
    /// What a turn of one does to the way of the other: half their product, between the ends [m].
    double bent() const noexcept { return std::min(kMostBent, 0.5 * (own.turn + other.turn) * (own.way + other.way)); }

    const Pose &last, &now;  // of the other part
    Pose carried;            // where the held part would be if it had gone with the other
    Going own, other, relative;
    bool far = false;
};

/// True if the held part meets a part of another hand on their common way; `meets(i, X_WO, X_WG, most)` says whether
/// it does by more than `most` at two poses.
template <class Meets>
bool crosses(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WG, double accepted,
             Meets meets) noexcept {
    for (const ObstaclePoses::Carried& in_hand : obstacles.inHands()) {
        const CommonWay way(model, obstacles, X_WG, in_hand);
        const double most = accepted + way.bent();
        if (way.least() <= most) continue;
        const double pieces = std::ceil(way.relative.way / kLongestPiece) + 1.0;
        if (pieces > kMostPieces) return true;
        for (int piece = 1; piece < static_cast<int>(pieces); ++piece) {
            const double share = piece / pieces;
            if (meets(in_hand.obstacle, between(way.last, way.now, share), between(obstacles.X_WG_begin, X_WG, share),
                      most))
                return true;
        }
    }
    return false;
}

}  // namespace

void keepCommonWay(const HandModel& model, const ObstaclePoses& obstacles, Proxy& proxy, QueryMemory& memory,
                   Report& report) noexcept {
    const double accepted = std::max(model.margins.accept, overlap(proxy));
    const auto meets = [&](std::uint32_t i, const Pose& X_WO, const Pose& X_WG, double most) {
        return overlapsObstacle(model, i, X_WO, X_WG, most, memory, report);
    };
    if (!crosses(model, obstacles, proxy.X_WG, accepted, meets)) return;
    report.status |= kSuspended;
    surveyContacts({model, proxy, memory, report, obstacles}, obstacles.X_WG_begin);
}

void keepCommonWayInClosedForm(const HandModel& model, const ObstaclePoses& obstacles, Proxy& proxy,
                               ClosedFormMemory& memory, Report& report) noexcept {
    const auto meets = [&](std::uint32_t i, const Pose& X_WO, const Pose& X_WG, double most) {
        closed_form::ContactSearch& search = memory.at_hand[i];
        search.place(X_WO);
        return search.overlapAt(X_WG).depth > most;
    };
    const bool crossed = crosses(model, obstacles, proxy.X_WG, kAcceptedOnWay + overlap(proxy), meets);
    for (const auto& in_hand : obstacles.inHands())
        memory.at_hand[in_hand.obstacle].place(obstacles.X_WO[in_hand.obstacle]);
    if (!crossed) return;
    report.status |= kSuspended;
    proxy.X_WG = obstacles.X_WG_begin;
}

}  // namespace passung::tick
