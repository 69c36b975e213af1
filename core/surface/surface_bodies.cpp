// What surface_proxy.h says of bodies: where they are, which are in reach, and what is known after one moved.

#include <algorithm>
#include <cmath>

#include "core/surface/surface_proxy.h"

namespace passung::surface {

namespace {

constexpr double kLeaves = 5e-3;      // [m]: beyond twice the reach, until a body is forgotten
constexpr double kFadingMoves = 0.9;  // of what bodies usually come nearer, from one motion to the next
constexpr double kLeastHurry = 1.0 / 64;
constexpr double kTrueEnough = 1.2;  // gaps: faces nearer are sorted anew
constexpr int kMoveWork = 60;        // units of work
constexpr std::size_t kLooked = 8;   // near pairs for a unit of work
constexpr std::size_t kMostDue = 2500;

}  // namespace

void KnownBody::put(const Pose& X) noexcept {
    X_WB = X;
    to_world = Placement(X);
    is_world = to_world.R == Mat3::Identity() && to_world.p == Vec3::Zero();
}

Placement KnownBody::seen(const Placement& X) const noexcept {
    if (is_world) return X;
    Placement in;
    in.R.noalias() = to_world.R.transpose() * X.R;
    in.p = to_world.R.transpose() * (X.p - to_world.p);
    return in;
}

Placement KnownBody::seenFrom(const Pose& frame, const Placement& X) const noexcept {
    const Placement to_world_then(frame);
    Placement in;
    in.R.noalias() = to_world_then.R.transpose() * X.R;
    in.p = to_world_then.R.transpose() * (X.p - to_world_then.p);
    return in;
}

/// How far the box around the held part is from that of the body at least, at the pose of now.
double SurfaceProxy::clearanceOf(const KnownBody& body) const noexcept {
    const geometry::Bounds &box = held_->box(), &other = body.tree->box();
    const Placement X = body.seen(P_);
    const Vec3 half = 0.5 * (X.R.cwiseAbs() * box.size() + other.size());
    const Vec3 between = X * (0.5 * (box.low + box.high)) - 0.5 * (other.low + other.high);
    return (between.cwiseAbs() - half).cwiseMax(0.0).norm();
}

/// How near a body may be and still cannot be met in this tick, nor by the look that was begun, nor be told.
double SurfaceProxy::reach() const noexcept {
    return std::max({most_in_tick_, kFastest, phase_ == Phase::Idle ? 0.0 : way_}) + gap_ + kSeen;
}

/// Which bodies are in reach. One alone always is.
void SurfaceProxy::findReach() noexcept {
    if (bodies_.size() == 1) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        const double far = reach() + strayOf(body);
        if (!body.in_reach && body.clear >= travelled_ + far) continue;
        const double apart = clearanceOf(body);
        if (body.in_reach ? apart > 2.0 * far + kLeaves && phase_ == Phase::Idle : apart >= far) {
            // Boxes apart: nothing lies within the other.
            if (body.in_reach) forget(i);
            forest_.clear(i);
            body.in_reach = body.asks = false;
            body.clear = travelled_ + apart;
        } else if (!body.in_reach) {
            giveUpLook();
            body.P = body.seen(P_);
            forget(i);
            body.in_reach = body.behind = true;
        }
    }
}

/// All that is known of a body; its roots wait.
void SurfaceProxy::forget(std::size_t i) noexcept {
    KnownBody& body = bodies_[i];
    std::size_t kept = 0;
    for (std::size_t k = 0; k < near_count_; ++k)
        if (near_[k].body != i) near_[kept++] = near_[k];
    near_count_ = kept;
    kept = 0;
    for (std::size_t k = 0; k < row_count_; ++k)
        if (rows_[k].body != i) rows_[kept++] = rows_[k];
    row_count_ = kept;
    forest_.restart(i);
    body.settled.fill(0.0);
    body.ahead.fill(0.0);
    body.usual.fill(0.0);
    body.moved = body.behind = false;
}

void SurfaceProxy::ask(KnownBody& body) noexcept {
    body.asks = asks_ = true;
    body.enclosure.restart();
}

void SurfaceProxy::giveUpLook() noexcept {
    gone_.setZero();
    if (phase_ == Phase::Idle) return;
    phase_ = Phase::Idle;
    hurry_ = std::max(kLeastHurry, 0.5 * hurry_);
}

/// After triangles crossed, or at a new place: finds out whether something lies within the other part, once none cross
/// any more. False: the budget ended.
bool SurfaceProxy::knowsItsSide() noexcept {
    if (!asks_) return true;
    overlaps_ = false;
    for (std::size_t i = 0; i < near_count_; ++i) overlaps_ = overlaps_ || near_[i].meets;
    if (overlaps_) return true;
    const Vec3 hand = X_WH_last_ ? Vec3(X_WH_last_->p - X_.p) : Vec3::Zero();
    for (KnownBody& body : bodies_) {
        if (!body.asks) continue;
        if (!body.enclosure.advance(body.P, body.direction(hand), tick_.work, budget_)) return false;
        body.asks = false;
        if (!body.enclosure.encloses()) continue;
        const Vec3 way = body.directionInWorld(body.enclosure.wayOut());
        left_to_lead_ = way.norm();
        lead_ = way / left_to_lead_;
        row_count_ = 0;
        break;
    }
    asks_ = std::any_of(bodies_.begin(), bodies_.end(), [](const KnownBody& body) { return body.asks; });
    return true;
}

/// A tick on the way out of the other part. At its end all is looked at anew.
const SurfaceTick& SurfaceProxy::lead() noexcept {
    const double step = std::min(left_to_lead_, kFastest);
    left_to_lead_ -= step;
    X_.p += step * lead_;
    P_ = Placement(X_);
    chain_[chain_count_++] = X_;
    tick_.X_WG = X_;
    tick_.meets = true;
    tick_.looks = 1;
    ++tick_.work;
    if (left_to_lead_ > 0.0) return tick_;
    const std::optional<Pose> X_WH = X_WH_last_;
    place(X_);
    X_WH_last_ = X_WH;
    return tick_;
}

void SurfaceProxy::moveBody(std::size_t i, const Pose& X_WB) noexcept {
    KnownBody& body = bodies_[i];
    if (X_WB.p == body.X_WB.p && X_WB.q.coeffs() == body.X_WB.q.coeffs()) return;
    body.put(X_WB);
    ++owed_;
    if (!body.in_reach) {
        const double apart = clearanceOf(body);
        body.clear = travelled_ + apart;
        if (apart < reach()) giveUpLook();  // it is found in the next tick
        return;
    }
    giveUpLook();
    if (body.asks) body.enclosure.restart();
    const Placement before = body.P;
    body.P = body.seen(P_);
    PerClass nearer;
    measureApproach(held_->box(), body.P.R - before.R, body.P.p - before.p, nearer);
    owed_ += kMoveWork;
    const double most = *std::max_element(nearer.begin(), nearer.end());
    if (most > kVoid) {
        owed_ += static_cast<int>(near_count_ / kLooked);
        forget(i);
        body.behind = true;
        return;
    }
    swept_ = std::max(swept_, wayBetween(before, body.P));
    if (!body.moved) body.P_known = before;
    body.moved = moved_ = true;
    forest_.travel(i, nearer);
    for (std::size_t c = 0; c < NormalClass::kCount; ++c)
        body.usual[c] = std::max(nearer[c], kFadingMoves * body.usual[c]);
}

void SurfaceProxy::placeBody(std::size_t i, const Pose& X_WB) noexcept {
    KnownBody& body = bodies_[i];
    giveUpLook();
    body.put(X_WB);
    body.P = body.seen(P_);
    owed_ += kMoveWork + static_cast<int>(near_count_ / kLooked);
    forget(i);
    ask(body);
    body.behind = true;
    if (bodies_.size() == 1) return;
    body.in_reach = false;  // until it is found
    body.clear = 0.0;
}

/// A near pair waits. Until it is sorted it is told by what is known of it.
void SurfaceProxy::release(std::size_t at) noexcept {
    const NearPair gone = near_[at];
    near_[at] = near_[--near_count_];
    KnownBody& body = bodies_[gone.body];
    if (gone.meets) ask(body);
    const std::size_t c = NormalClass::of(gone.n);
    const double s = gone.meets ? 0.0 : std::max(0.0, gone.s);
    body.settled[c] = std::min(body.settled[c], forest_.travelledOf(PairForest::listOf(gone.body, c)) + s);
    forest_[gone.pair].n = gone.n;
    forest_.wait(gone.pair);
}

/// What is left of near pairs after bodies moved. Those with too little of it wait, and those that are far sleep.
void SurfaceProxy::moveNear() noexcept {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        if (!body.moved) continue;
        body.turn = body.P.R - body.P_known.R;
        body.move = body.P.p - body.P_known.p;
        setSleeps(i);
    }
    tick_.work += static_cast<int>(near_count_ / kLooked);
    for (std::size_t i = 0; i < near_count_;) {
        NearPair& near = near_[i];
        const KnownBody& body = bodies_[near.body];
        if (!body.moved) {
            ++i;
            continue;
        }
        ++tick_.work;
        const Vec3 m = body.turn.transpose() * near.n;
        near.s += near.n.dot(body.move) + m.dot(near.centre) - m.norm() * near.radius;
        near.n_next = near.n;
        if (near.meets || !(near.s > (near.faces ? kTrueEnough : 1.0) * gap_)) {
            release(i);
        } else if (body.sleepsWith(near.n, near.s)) {
            const NearPair gone = near;
            near_[i] = near_[--near_count_];
            fallAsleep(gone.pair, gone.n, gone.s);
        } else {
            ++i;
        }
    }
    for (KnownBody& body : bodies_) {
        body.behind = body.behind || body.moved;
        body.moved = false;
    }
    moved_ = false;
}

/// Finds out what bodies that moved came near to. False: the budget ended; what is known by then is kept.
bool SurfaceProxy::catchUp() noexcept {
    if (moved_) moveNear();
    bool any = false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        if (!body.behind) continue;
        any = true;
        for (bool due = true; due;) {
            if (!settle()) return false;
            due = false;
            std::size_t woken = 0;
            for (std::size_t c = 0; c < NormalClass::kCount; ++c) {
                const std::size_t list = PairForest::listOf(i, c);
                if (forest_.sureOf(list) >= gap_) continue;
                woken += forest_.wake(list, gap_, kMostDue - std::min(woken, kMostDue));
                due = true;
            }
        }
        body.behind = false;
    }
    if (!any) return true;
    overlaps_ = false;
    for (std::size_t k = 0; k < near_count_; ++k) {
        overlaps_ = overlaps_ || near_[k].meets;
        if (near_[k].meets) ask(bodies_[near_[k].body]);
    }
    return true;
}

}  // namespace passung::surface
