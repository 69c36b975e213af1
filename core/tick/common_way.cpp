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

/// True if the held part meets a part of another hand on their common way; `meets(i, X_WO, X_WG, most)` says whether
/// it does by more than `most` at two poses.
template <class Meets>
bool crosses(const HandModel& model, const ObstaclePoses& obstacles, const Pose& X_WG, double accepted,
             Meets meets) noexcept {
    const Pose& X_WG_last = obstacles.X_WG_last;
    for (std::size_t k = 0; k < model.moving.size(); ++k) {
        const std::uint32_t i = model.moving[k];
        const Pose &last = obstacles.X_WO_last[k], &now = obstacles.X_WO[i];
        if (now.p == last.p && now.q.coeffs() == last.q.coeffs()) continue;
        // Both as points of the held part go, since those of the other part are near them where they could meet.
        const Pose carried = now * last.inverse();
        const Going own(X_WG_last, X_WG, model.reach), other(X_WG_last, carried * X_WG_last, model.reach);
        const Going relative(carried * X_WG_last, X_WG, model.reach);
        // What a turn of one does to the way of the other: half their product, between the ends.
        const double bent = std::min(kMostBent, 0.5 * (own.turn + other.turn) * (own.way + other.way));
        const double most = accepted + bent;
        if (std::min({own.way, other.way, relative.way}) <= most) continue;
        const double pieces = std::ceil(relative.way / kLongestPiece) + 1.0;
        if (pieces > kMostPieces) return true;
        for (int piece = 1; piece < static_cast<int>(pieces); ++piece) {
            const double share = piece / pieces;
            if (meets(i, between(last, now, share), between(X_WG_last, X_WG, share), most)) return true;
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
    surveyContacts({model, proxy, memory, report, obstacles}, obstacles.X_WG_last);
}

void keepCommonWayInClosedForm(const HandModel& model, const ObstaclePoses& obstacles, Proxy& proxy,
                               ClosedFormMemory& memory, Report& report) noexcept {
    const auto meets = [&](std::uint32_t i, const Pose& X_WO, const Pose& X_WG, double most) {
        closed_form::ContactSearch& search = memory.at_hand[i];
        search.place(X_WO);
        return search.overlapAt(X_WG).depth > most;
    };
    const bool crossed = crosses(model, obstacles, proxy.X_WG, kAcceptedOnWay + overlap(proxy), meets);
    for (const std::uint32_t i : model.moving) memory.at_hand[i].place(obstacles.X_WO[i]);
    if (!crossed) return;
    report.status |= kSuspended;
    proxy.X_WG = obstacles.X_WG_last;
}

}  // namespace passung::tick
