// What surface_proxy.h says of bodies in other hands: the way that the part and they go at once, from where the tick
// began.

#include <algorithm>
#include <cmath>

#include "core/surface/straight_way.h"
#include "core/surface/surface_proxy.h"

namespace passung::surface {

namespace {

constexpr int kMostShortened = 3;          // times, of a look
constexpr double kCrossed = 1e-9;          // [m], or touched
constexpr double kCommonRounding = 1e-10;  // [m]
constexpr int kBackWork = 40;              // units of work, of one body
constexpr double kBeyondWays = 2.0;        // of the way since the tick began: what may be met besides

int workOfLooks(const HullPair& pair, int looks) {
    return looks * (3 + static_cast<int>(pair.of_held.count + pair.of_obstacle.count) / 8);
}

}  // namespace

void SurfaceProxy::beginTick(std::size_t i, const Pose& X_WB) noexcept {
    KnownBody& body = bodies_[i];
    KnownBody::Common& common = body.common;
    const Placement before = common.begin;
    common.shared = true;
    common.crossed = false;
    const bool there = X_WB.p == body.X_WB.p && X_WB.q.coeffs() == body.X_WB.q.coeffs();
    common.begin = there ? body.seen(P_) : body.seenFrom(X_WB, P_);
    if (phase_ != Phase::Idle && body.in_reach && (before.p != common.begin.p || before.R != common.begin.R))
        giveUpLook();
}

/// How far beside its reach a body may be met on the common way.
double SurfaceProxy::strayOf(const KnownBody& body) const noexcept {
    return body.common.shared ? kBeyondWays * wayBetween(body.common.begin, body.seen(P_)) : 0.0;
}

/// What has come nearer since the tick began, class by class, if the part went back to where it was then.
void SurfaceProxy::lookBack() noexcept {
    for (KnownBody& body : bodies_) {
        if (!body.in_reach || !body.common.shared) continue;
        const Placement& begin = body.common.begin;
        if (begin.p == body.P.p && begin.R == body.P.R) {
            body.common.back.fill(0.0);
            continue;
        }
        measureApproach(held_->box(), begin.R - body.P.R, begin.p - body.P.p, body.common.back);
        tick_.work += kBackWork;
    }
}

/// The way from there to the end of the look. The part goes straight as the body sees it, and the body as the part
/// does: two ways of one turn R(t), on which the part is at (1 - t) p0 + t p1, and at (1 - t) R(t) R0ᵀ p0 + t R(t) R1ᵀ
/// p1. By the series of sines and cosines these are no farther apart than θ |p1 - p0| / 4 + θ² |p| / 6 with |p| the
/// larger one, up to half a turn. A plane that leaves as much at both ends, and besides the rise R θ²/8, proves both
/// ways.
void SurfaceProxy::measureCommonWay(KnownBody& body) const noexcept {
    KnownBody::Common& common = body.common;
    common.turn = common.begin.R - body.P_next.R;
    common.move = common.begin.p - body.P_next.p;
    // |R1 - R0| = 2 √2 sin θ/2
    const double angle = 2.0 * std::asin(std::min(1.0, common.turn.norm() / std::sqrt(8.0)));
    const double far = std::max(common.begin.p.norm(), body.P_next.p.norm());
    common.bent =
        0.25 * angle * common.move.norm() + (held_->reach() / 8.0 + far / 6.0) * angle * angle + kCommonRounding;
}

/// True if a near pair, proven for the look, stays apart on the common way to the end of it.
bool SurfaceProxy::keepsCommonWay(const NearPair& near) noexcept {
    KnownBody& body = bodies_[near.body];
    KnownBody::Common& common = body.common;
    if (!common.shared || common.crossed || overlaps_) return true;
    ++tick_.work;
    const Vec3& n = near.n_next;
    if (near.s_next >= common.bent) {
        const Vec3 m = common.turn.transpose() * n;
        if (near.s_next + n.dot(common.move) + m.dot(near.centre) - m.norm() * near.radius >= common.bent) return true;
    }
    const HullPair pair = hulls(near.pair);
    const Mat3 back = common.begin.R * body.P_next.R.transpose();
    // The plane of the body, or one that turns with the held part.
    Vec3 n0 = n, n1 = n;
    double s0 = separationAlong(pair, common.begin, n0);
    const double s1 = separationAlong(pair, body.P_next, n1);
    tick_.work += workOfLooks(pair, 1);
    if (s0 >= common.bent && s1 >= common.bent) return true;
    if (const Vec3 carried = back * n; s0 < s1) {
        const double s = separationAlong(pair, common.begin, carried);
        if (s > s0) n0 = carried;
        s0 = std::max(s0, s);
    }
    const StraightWay way(common.begin, body.P_next), mirrored_way = way.mirrored();
    const HullPair mirrored{pair.obstacle, pair.held, pair.of_obstacle, pair.of_held};
    const auto seenByPart = [](const Placement& X, const Vec3& m) { return Vec3(-(X.R.transpose() * m)); };
    bool apart = setsApart(pair, way, n0, n1, std::min(s0, s1)) &&
                 setsApart(mirrored, mirrored_way, seenByPart(way.from, n0), seenByPart(way.to, n1), std::min(s0, s1));
    int looks = 1;
    if (!apart) {
        CornerSeed seed = near.seed;
        const NearestHulls end = nearestPoints(pair, body.P_next, n1, seed);
        const NearestHulls begin = nearestPoints(pair, common.begin, back * end.n, seed);
        looks += end.looks + begin.looks;
        apart = !begin.meets && !end.meets && keepsApart(pair, way, begin.n, end.n, looks) &&
                keepsApart(mirrored, mirrored_way, seenByPart(way.from, begin.n), seenByPart(way.to, end.n), looks);
    }
    tick_.work += workOfLooks(pair, looks);
    if (!apart && near.faces) common.crossed = crossedAtBegin(near.body);
    return apart || common.crossed;
}

/// True if faces crossed or touched where the tick began: one of the parts is led out of the other, and no way is free.
bool SurfaceProxy::crossedAtBegin(std::size_t i) noexcept {
    const Placement& begin = bodies_[i].common.begin;
    for (std::size_t k = 0; k < near_count_; ++k) {
        const NearPair& near = near_[k];
        if (near.body != i || !near.faces) continue;
        const HullPair pair = hulls(near.pair);
        tick_.work += workOfLooks(pair, 1);
        if (separationAlong(pair, begin, near.n) > kCrossed) continue;
        const NearestHulls then = nearestHulls(pair, begin, near.n, kCrossed, 0.0);
        tick_.work += workOfLooks(pair, then.looks);
        if (then.separation <= kCrossed) return true;
    }
    return false;
}

/// Half of a look whose common way is not free. False: it is given up.
bool SurfaceProxy::shorten() noexcept {
    tick_.waits = true;
    ++shortened_;
    u_ *= 0.5;
    limited_ = true;
    limit(most_way_);
    if (shortened_ > kMostShortened || !(way_ > 0.0)) {
        phase_ = Phase::Idle;
        return false;
    }
    measureNearer();
    at_ = 0;
    front_only_ = true;
    violated_ = false;
    added_ = 0;
    least_share_ = 1.0;
    if (shareKnown() < 1.0) phase_ = Phase::Waking;
    return true;
}

}  // namespace passung::surface
