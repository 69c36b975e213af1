// What surface_proxy.h says of pairs: which are asleep, which near, and what is proven of those.

#include <algorithm>
#include <cmath>

#include "core/surface/surface_proxy.h"

namespace passung::surface {

namespace {

constexpr double kFloor = 0.4;         // of the gap: what a pose may leave
constexpr double kShrink = 0.9;        // of a separation below that: what it may leave
constexpr double kOnTheWay = 0.5;      // of what has to be left at the end: what has to be there in between
constexpr double kAhead = 1.0;         // of a way: what a plane should hold beyond it
constexpr double kRounding = 1e-10;    // [m]
constexpr double kMargin = 1.2;        // of what a look brings nearer, for who may sleep meanwhile
constexpr double kFading = 0.9;        // of what looks usually bring nearer, from one to the next
constexpr double kMergeBeyond = 5e-5;  // [m]: nearer pairs stay split
constexpr double kMergeShare = 0.25;   // of its children's separation, which a pair needs to take their place
constexpr int kMostAdded = 8;          // rows in a round
constexpr int kFetched = 4;            // units of work: a pair that nothing was read of lately
constexpr int kTouchSteps = 3;         // halvings of a way on which two faces come to each other
constexpr int kTurnSteps = 2;          // halvings of a way whose turning plane is to be proven

int workOf(const HullPair& pair) { return 3 + static_cast<int>(pair.of_held.count + pair.of_obstacle.count) / 8; }

}  // namespace

HullPair SurfaceProxy::hulls(std::uint32_t pair) const noexcept {
    const ClusterPair& of = forest_[pair];
    const ClusterTree& tree = *bodies_[of.body].tree;
    return {*held_, tree, (*held_)[of.held], tree[of.obstacle]};
}

void SurfaceProxy::setSleeps(std::size_t i) noexcept {
    KnownBody& body = bodies_[i];
    for (std::size_t c = 0; c < NormalClass::kCount; ++c)
        body.sleeps[c] =
            std::max({kSeen, std::max(kMargin * body.ahead[c], body.usual[c]) + gap_ + 2.0 * PairForest::kBucket,
                      forest_.sureOf(PairForest::listOf(i, c)) + PairForest::kBucket});
}

/// Sorts those that wait. False: the budget ended.
bool SurfaceProxy::settle() noexcept {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        if (!body.in_reach) continue;
        if (forest_.hasWaiting(i)) {
            setSleeps(i);
            const double any = *std::max_element(body.sleeps.begin(), body.sleeps.end());
            while (forest_.hasWaiting(i)) {
                if (spent()) return false;
                sort(forest_.takeWaiting(i), any);
            }
        }
        for (std::size_t c = 0; c < NormalClass::kCount; ++c) body.settled[c] = forest_.dueOf(PairForest::listOf(i, c));
    }
    return true;
}

void SurfaceProxy::push(std::uint32_t pair, const Vec3& n, double s, bool meets) noexcept {
    forest_[pair].now = ClusterPair::Now::Near;
    const HullPair of = hulls(pair);
    const bool faces = of.of_held.isFace() && of.of_obstacle.isFace();
    near_[near_count_++] = {n,    n,     s,     s,  of.of_held.centre, of.of_held.radius,
                            pair, meets, faces, {}, forest_[pair].body};
}

/// Finds out whether a pair that waits is far, near, or too near to be one. `any`: a pair farther apart sleeps whatever
/// its plane is.
void SurfaceProxy::sort(std::uint32_t at, double any) noexcept {
    const HullPair pair = hulls(at);
    const KnownBody& body = bodies_[forest_[at].body];
    const Vec3 between = body.P * pair.of_held.centre - pair.of_obstacle.centre;
    const double apart = between.norm();
    tick_.work += kFetched;
    const double by_balls = apart - pair.of_held.radius - pair.of_obstacle.radius;
    if (by_balls >= any) return fallAsleep(at, between / apart, by_balls);
    const Vec3 last = forest_[at].n;
    const bool faces = pair.of_held.isFace() && pair.of_obstacle.isFace();
    const NearestHulls nearest = nearestHulls(pair, body.P, last, body.sleeps, faces ? kRounding : gap_);
    tick_.work += nearest.looks * workOf(pair);
    if (body.sleepsWith(nearest.n, nearest.separation)) return fallAsleep(at, nearest.n, nearest.separation);
    if (nearest.separation > (faces ? 0.0 : gap_)) return push(at, nearest.n, nearest.separation, false);
    if (faces) return push(at, nearest.n, 0.0, true);
    const std::uint32_t child = splitPair(at);
    if (child == ClusterPair::kNoPair) return push(at, nearest.n, 0.0, false);
    forest_.wait(child);
    forest_.wait(child + 1);
}

/// Puts a pair to sleep, and where its sibling sleeps too and both are far, their parent in their place.
void SurfaceProxy::fallAsleep(std::uint32_t at, const Vec3& n, double s) noexcept {
    for (;;) {
        ++tick_.work;
        forest_.sleep(at, n, s);
        const std::uint32_t parent = forest_[at].parent;
        if (parent == ClusterPair::kNoPair || s < kMergeBeyond) return;
        const std::uint32_t first = forest_[parent].child, sibling = at == first ? first + 1 : first;
        if (forest_[sibling].now != ClusterPair::Now::Asleep) return;
        const double least = std::min(s, forest_.apart(sibling));
        if (least < kMergeBeyond) return;
        const HullPair pair = hulls(parent);
        tick_.work += workOf(pair);
        const std::size_t body = forest_[parent].body;
        const double both = separationAlong(pair, bodies_[body].P, n);
        if (both < std::max(kMergeShare * least, kMergeBeyond) ||
            both <= forest_.sureOf(PairForest::listOf(body, NormalClass::of(n))))
            return;
        forest_.merge(parent);
        at = parent;
        s = both;
    }
}

/// The larger of the two clusters is parted.
std::uint32_t SurfaceProxy::splitPair(std::uint32_t at) noexcept {
    const HullPair pair = hulls(at);
    const bool held =
        pair.of_obstacle.isFace() || (!pair.of_held.isFace() && pair.of_held.radius > pair.of_obstacle.radius);
    const std::uint32_t child = forest_.trySplit(at);
    if (child == ClusterPair::kNoPair) return child;
    tick_.work += 4;
    for (std::uint32_t i = 0; i < 2; ++i) {
        if (held)
            forest_[child + i].held = pair.of_held.child + i;
        else
            forest_[child + i].obstacle = pair.of_obstacle.child + i;
    }
    return child;
}

/// A near pair's children take its place.
bool SurfaceProxy::trySplit(std::size_t at) noexcept {
    if (near_[at].faces || near_count_ == near_.size()) return false;
    const NearPair whole = near_[at];
    const std::uint32_t child = splitPair(whole.pair);
    if (child == ClusterPair::kNoPair) return false;
    push(child + 1, whole.n, whole.s, false);
    push(child, whole.n, whole.s, false);
    near_[at] = near_[--near_count_];
    return true;
}

/// What has to be left at the end of a look.
double SurfaceProxy::needOf(double s, bool faces) const noexcept {
    return faces ? std::min(kFloor * gap_, kShrink * s) : gap_;
}

SurfaceProxy::Checked SurfaceProxy::check() noexcept {
    for (;;) {
        const std::size_t end = front_only_ ? front_ : near_count_;
        if (at_ >= end || added_ >= kMostAdded) {
            if (violated_) return Checked::Violated;
            if (!front_only_) return Checked::Passed;
            front_only_ = false;
            continue;
        }
        if (spent()) return Checked::Spent;
        const bool proven = near_[at_].meets || proves(near_[at_]);
        if (proven && (violated_ || keepsCommonWay(near_[at_]))) {
            ++at_;
            continue;
        }
        if (trySplit(at_)) continue;
        if (proven) {
            if (at_ >= front_) std::swap(near_[at_], near_[front_++]);
            return Checked::Astray;
        }
        if (overlaps_ && near_[at_].faces) {
            near_[at_++].meets = true;  // a face that is left from its back
            continue;
        }
        addRow(near_[at_]);
        violated_ = true;
        ++added_;
        if (at_ >= front_) std::swap(near_[at_], near_[front_++]);
        ++at_;
    }
}

/// True if the pair stays apart at the end of the look and on the way.
bool SurfaceProxy::proves(NearPair& near) noexcept {
    const double need = needOf(near.s, near.faces);
    const double on_the_way = kOnTheWay * need + arc_ + kRounding;
    const KnownBody& body = bodies_[near.body];
    near.n_next = near.n;
    ++tick_.work;
    if (near.s >= on_the_way) {
        const Vec3 m = body.turn.transpose() * near.n;
        near.s_next = near.s + near.n.dot(body.move) + m.dot(near.centre) - m.norm() * near.radius;
        if (near.s_next >= need && near.s_next >= on_the_way) return true;
    }
    const HullPair pair = hulls(near.pair);
    if (near.s >= on_the_way) {
        near.s_next = separationAlong(pair, body.P_next, near.n);
        tick_.work += workOf(pair);
        if (near.s_next >= need && near.s_next >= on_the_way) return true;
    }
    const double enough = std::max(need, on_the_way);
    const NearestHulls swept = nearestHulls(pair, body.P, body.P_next, near.n, enough + kAhead * way_,
                                            near.faces ? on_the_way : enough, near.seed);
    tick_.work += swept.looks * workOf(pair);
    if (swept.separation >= enough) {
        near.n = near.n_next = swept.n;
        near.s = separationAlong(pair, body.P, swept.n);
        near.s_next = separationAlong(pair, body.P_next, swept.n);
        return true;
    }
    return near.faces && provesFaces(near, pair, swept.separation);
}

/// With the planes that are best at either end. `swept`: what one plane sets both ends apart by.
bool SurfaceProxy::provesFaces(NearPair& near, const HullPair& pair, double swept) noexcept {
    const KnownBody& body = bodies_[near.body];
    const NearestHulls now = nearestPoints(pair, body.P, near.n, near.seed);
    tick_.work += now.looks * workOf(pair);
    if (now.separation > near.s) {
        near.s = now.separation;
        near.n = near.n_next = now.n;
    }
    const double need = needOf(near.s, true);
    const NearestHulls then = nearestPoints(pair, body.P_next, near.n, near.seed);
    tick_.work += then.looks * workOf(pair);
    if (then.meets || then.separation < need) return false;
    near.n_next = then.n;
    near.s_next = then.separation;
    const double on_the_way = kOnTheWay * need + arc_ + kRounding;
    if (swept >= on_the_way) return true;
    tick_.work += 3 * workOf(pair);
    if (provesTurning(pair, {body.P, near.n}, {body.P_next, then.n}, on_the_way)) return true;
    const Vec3 carried = body.P_next.R * (body.P.R.transpose() * near.n);
    if (provesTurning(pair, {body.P, near.n}, {body.P_next, carried}, on_the_way)) {
        const double s = separationAlong(pair, body.P_next, carried);
        if (s >= need) {
            near.n_next = carried;
            near.s_next = s;
        }
        return true;
    }
    return provesParts(near, pair, then.n, kOnTheWay * need);
}

/// The way in pieces, each with the planes that are best at its ends.
bool SurfaceProxy::provesParts(const NearPair& near, const HullPair& pair, const Vec3& n_end, double need) noexcept {
    constexpr int kParts = 1 << kTurnSteps;
    const KnownBody& body = bodies_[near.body];
    PlaneAt from{body.P, near.n};
    CornerSeed seed = near.seed;
    for (int i = 1; i <= kParts; ++i) {
        PlaneAt to{body.P_next, n_end};
        if (i < kParts) {
            to.X = body.seen(Placement(poseOnWay(i / double(kParts))));
            const NearestHulls there = nearestPoints(pair, to.X, from.n, seed);
            tick_.work += there.looks * workOf(pair);
            if (there.meets) return false;
            to.n = there.n;
        }
        tick_.work += 2 * workOf(pair);
        if (!provesTurning(pair, from, to, need + arc_ / (kParts * kParts) + kRounding)) return false;
        from = to;
    }
    return true;
}

/// The Bernstein coefficients of the way between, against `need`.
bool SurfaceProxy::provesTurning(const HullPair& pair, const PlaneAt& from, const PlaneAt& to,
                                 double need) const noexcept {
    if (separationAlong(pair, from.X, from.n) < need || separationAlong(pair, to.X, to.n) < need) return false;
    const double held =
        leastReachOf(pair.held, pair.of_held, to.X.R.transpose() * from.n + from.X.R.transpose() * to.n) +
        from.n.dot(to.X.p) + to.n.dot(from.X.p);
    return 0.5 * (held + leastReachOf(pair.obstacle, pair.of_obstacle, -(from.n + to.n))) >= need;
}

Pose SurfaceProxy::poseOnWay(double share) const noexcept { return settings_.metric.moved(X_, u_, share); }

/// True if no point of the way between two poses comes nearer than `need`.
bool SurfaceProxy::staysApart(const HullPair& pair, const PlaneAt& from, const PlaneAt& to, double need) noexcept {
    tick_.work += 2 * workOf(pair);
    if (separationAlong(pair, to.X, from.n) >= need || separationAlong(pair, from.X, to.n) >= need) return true;
    if (provesTurning(pair, from, to, need)) return true;
    CornerSeed seed;
    const NearestHulls swept = nearestHulls(pair, from.X, to.X, from.n, need, need, seed);
    tick_.work += swept.looks * workOf(pair);
    return swept.separation >= need;
}

/// A row that keeps two faces apart, of where they come to each other first on the way.
void SurfaceProxy::addRow(NearPair& near) noexcept {
    if (!near.faces) {
        least_share_ = 0.0;  // no room to split it
        return;
    }
    const HullPair pair = hulls(near.pair);
    const KnownBody& body = bodies_[near.body];
    Placement X = body.P;
    CornerSeed seed = near.seed;
    NearestHulls there = nearestPoints(pair, body.P, near.n, seed);
    const double need = needOf(near.s, true);
    double from = 0.0, to = 1.0;
    int looks = there.looks;
    for (int i = 0; i < kTouchSteps; ++i) {
        const double middle = 0.5 * (from + to);
        const Placement X_middle = body.seen(Placement(poseOnWay(middle)));
        const NearestHulls now = nearestPoints(pair, X_middle, there.n, seed);
        looks += now.looks;
        if (!now.meets && now.separation >= need &&
            staysApart(pair, {X, there.n}, {X_middle, now.n}, kOnTheWay * need + arc_ + kRounding)) {
            from = middle;
            there = now;
            X = X_middle;
        } else {
            to = middle;
        }
    }
    tick_.work += looks * workOf(pair);
    least_share_ = std::min(least_share_, from);
    if (there.meets || there.separation <= 0.0) return;
    ContactRow row = rowBetween(pair, body.P, X, there, body.P_next);
    if (!(row.s > 0.0)) return;
    row.body = near.body;
    row.held = forest_[near.pair].held;
    row.obstacle = forest_[near.pair].obstacle;
    std::size_t place = row_count_;
    for (std::size_t i = 0; i < row_count_; ++i) {
        if (!rows_[i].isLike(row)) continue;
        row.push = rows_[i].push;
        if (!row.fixed) rows_[i] = row;
        return;
    }
    if (place == kMostRows) {
        for (place = 0; place < kMostRows && rows_[place].push > 0.0;) ++place;
    } else {
        ++row_count_;
    }
    if (place < kMostRows) rows_[place] = row;
}

/// The look's end becomes the pose; its planes those of the pairs.
void SurfaceProxy::accept() noexcept {
    rest_before_ = rest_;
    gone_ = u_;
    rubbed_ = patches_;
    if (limited_ && rounds_ == 0) trust_ = std::max(trust_, std::min(2.0 * trust_, kFastest));
    hurry_ = std::min(1.0, 2.0 * hurry_);
    X_ = X_next_;
    P_ = P_next_;
    travelled_ += way_;
    way_in_tick_ += way_;
    chain_[chain_count_++] = X_;
    ++tick_.looks;
    phase_ = Phase::Idle;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        if (!body.in_reach) continue;
        body.P = body.P_next;
        if (body.asks) body.enclosure.restart();
        forest_.travel(i, body.nearer);
        body.ahead = body.nearer;
        for (std::size_t c = 0; c < NormalClass::kCount; ++c)
            body.usual[c] = std::max(body.nearer[c], kFading * body.usual[c]);
        setSleeps(i);
    }
    overlaps_ = false;
    tick_.work += static_cast<int>(near_count_ / 2);
    for (std::size_t i = 0; i < near_count_;) {
        NearPair& near = near_[i];
        KnownBody& body = bodies_[near.body];
        near.n = near.n_next;
        near.s = near.meets ? 0.0 : near.s_next;
        if (near.meets || (near.faces && near.s < 1.2 * gap_)) {
            const HullPair pair = hulls(near.pair);
            const NearestHulls now = nearestPoints(pair, body.P, near.n, near.seed);
            tick_.work += now.looks * workOf(pair);
            if (now.separation > near.s) {
                near.n = near.n_next = now.n;
                near.s = now.separation;
                near.meets = false;
            }
        }
        if (body.sleepsWith(near.n, near.s)) {
            const NearPair gone = near;
            near_[i] = near_[--near_count_];
            fallAsleep(gone.pair, gone.n, gone.s);
            continue;
        }
        near.n_next = near.n;
        overlaps_ = overlaps_ || near.meets;
        if (near.meets) ask(body);
        ++i;
    }
}

}  // namespace passung::surface
