#include "core/surface/surface_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/surface/touching_pieces.h"

namespace passung::surface {

namespace {

constexpr double kStill = 1e-8;                  // [m]: a motion below this is none
constexpr double kGoodEnough = 2e-6;             // [m]: what a look leaves is of second order
constexpr double kGoodWhenSpent = 2e-5;          // [m], more than that where nothing is left of the budget
constexpr double kGoodShare = 0.03;              // of a tick's way, the same
constexpr double kLeastLeft = 0.05;              // of a tick's way: for less no look is begun
constexpr double kLeastTrust = 2e-5;             // [m]
constexpr double kEase = 3e-7;                   // of a gap that is too small [m/tick]
constexpr double kOpening = 1e-8;                // of the gap that is held [m/tick]
constexpr std::array kMoreShare{0.1, 0.4, 1.0};  // of a look's way: what it may change by without waking more
constexpr double kMoreLength = 2e-6;             // [m], beside that
constexpr double kArcShare = 0.5;                // of the least gap: most of an arc's rise
constexpr double kOpposite = -0.7;               // cosine of the normals of two sides
constexpr double kStraight = 0.95;               // cosine: they face each other
constexpr int kMostRefined = 8;                  // planes in a tick
constexpr int kMostGhosts = 3;                   // rounds of a look that drop some
constexpr double kCaught = 1e-7;                 // [m]: by a way below this a proxy is caught or at rest
constexpr double kTwins = 0.98;                  // cosine of the normals of two rows that hold
constexpr double kTogether = 2.0;                // gaps: faces nearer lie on each other
constexpr std::size_t kMostPieces = 512;
constexpr int kTouchingShare = 16;                        // of the budget, for finding where
constexpr std::ptrdiff_t kFewPairs = 8, kMorePairs = 64;  // of faces that lie on each other
constexpr int kFinePieces = 24;                           // of each where they are few
constexpr double kTold = 1e-9;                            // [m]: welding and rounding, which the told gap leaves out
constexpr std::size_t kLookedOver = 8;                    // near pairs for a unit of work
constexpr double kTouches = 1.2;                          // gaps: a row no farther away holds the pose
constexpr double kUnlimited = 0.1;                        // [m]: the least gap where nothing is near
constexpr std::size_t kMostWoken = 2500;
constexpr int kMostIdle = 3;  // ticks of a row that does not hold, and after rows held
constexpr int kMostRounds = 4;
constexpr int kMostShorter = 4;
constexpr double kSameWay = 0.8;  // cosine of two looks' ways
constexpr double kMostRelaxed = 8.0, kLeastRelaxed = 0.4;
constexpr double kNearlyWhole = 0.95;  // of a motion: shortened by less, it is not solved for again
constexpr double kPart = 0.3;          // of a motion that leaves an overlap: along the hand

constexpr int kApproachWork = 40;  // of one body more
constexpr int kRubWork = 24;       // of a row that friction takes up or lets go

std::size_t pairsFor(const ClusterTree& held, std::span<const SurfaceBody> bodies) {
    std::size_t size = held.size();
    for (const SurfaceBody& body : bodies) size += body.tree->size();
    return std::clamp<std::size_t>(16 * size, 1u << 16, 1u << 20);
}

}  // namespace

SurfaceProxy::SurfaceProxy(const ClusterTree& held, const ClusterTree& obstacles, const SurfaceSettings& settings)
    : SurfaceProxy(held, std::array{SurfaceBody{&obstacles, {}}}, settings) {}

SurfaceProxy::SurfaceProxy(const ClusterTree& held, std::span<const SurfaceBody> bodies,
                           const SurfaceSettings& settings)
    : held_(&held),
      settings_(settings),
      budget_(settings.budget),
      forest_(pairsFor(held, bodies), bodies.size()),
      near_(forest_.capacity() / 2 + bodies.size()),  // leaves of trees that part in two
      rows_(kMostRows),
      manifold_(kMostRows),
      gap_(settings.gap) {
    bodies_.reserve(bodies.size());
    for (const SurfaceBody& body : bodies) {
        KnownBody& known = bodies_.emplace_back(held, body);
        known.first_surface = friction_.size();
        for (const RubbingSurface& surface : body.rubbing) {
            known.first_triangles.push_back(surface.first_triangle);
            friction_.push_back(surface.friction);
        }
    }
    if (!friction_.empty()) touching_.resize(kMostPieces);
    place({});
}

void SurfaceProxy::place(const Pose& X_WG) noexcept {
    near_count_ = row_count_ = 0;
    X_ = X_WG;
    P_ = Placement(X_);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        KnownBody& body = bodies_[i];
        body.P = body.seen(P_);
        forget(i);
        ask(body);
        body.in_reach = bodies_.size() == 1;
        body.clear = 0.0;
        body.common.begin = body.P;
    }
    last_way_ = travelled_ = 0.0;
    hurry_ = 1.0;
    least_ = 0.0;
    overlaps_ = moved_ = false;
    left_to_lead_ = 0.0;
    let_go_ = false;
    X_WH_last_.reset();
    gone_.setZero();
    patches_ = rubbed_ = {};
    since_held_ = kMostIdle + 1;
    phase_ = Phase::Idle;
}

void SurfaceProxy::measureBy(const motion::Metric& metric) noexcept {
    settings_.metric = metric;
    giveUpLook();
}

void SurfaceProxy::prepare() {
    budget_ = std::numeric_limits<int>::max();
    tick_ = {};
    findReach();
    catchUp();
    settle();
    knowsItsSide();
    budget_ = settings_.budget;
    tell();
}

double SurfaceProxy::wayBetween(const Placement& from, const Placement& to) const noexcept {
    const geometry::Bounds& box = held_->box();
    const Mat3 D = to.R - from.R;
    const Vec3 d = to.p - from.p;
    double square = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 c(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                     i & 4 ? box.high.z() : box.low.z());
        square = std::max(square, (D * c + d).squaredNorm());
    }
    return std::sqrt(square);
}

/// Sets the end of the look to `u_`, made shorter where it goes farther than `most` or turns too far.
void SurfaceProxy::limit(double most) noexcept {
    const double rise = kArcShare * std::max(least_, kLeastGap * 0.01);
    const double angle = u_.tail<3>().norm() / settings_.metric.radius,
                 reach = held_->reach() + settings_.metric.distance();
    const double most_angle = std::sqrt(8.0 * rise / std::max(reach, 1e-9));
    if (angle > most_angle) {
        u_ *= most_angle / angle;
        limited_ = true;
    }
    for (int i = 0;; ++i) {
        X_next_ = settings_.metric.moved(X_, u_);
        P_next_ = Placement(X_next_);
        arc_ = reach * settings_.metric.at(X_).turnOf(u_).squaredNorm() / 8.0;
        way_ = wayBetween(P_, P_next_) + arc_;
        if (way_ <= most || i == 8) break;
        u_ *= 0.98 * most / way_;
        limited_ = true;
    }
    if (way_ > most) {
        u_.setZero();
        X_next_ = X_;
        P_next_ = P_;
        way_ = arc_ = 0.0;
        limited_ = true;
    }
}

/// What the look brings nearer, class by class, to each body.
void SurfaceProxy::measureNearer() noexcept {
    int measured = 0;
    for (KnownBody& body : bodies_) {
        if (!body.in_reach) continue;
        body.P_next = body.seen(P_next_);
        body.turn = body.P_next.R - body.P.R;
        body.move = body.P_next.p - body.P.p;
        measureApproach(held_->box(), body.turn, body.move, body.nearer);
        for (double& nearer : body.nearer) nearer = std::min(nearer + arc_, way_);
        if (body.common.shared) measureCommonWay(body);
        ++measured;
    }
    tick_.work += kApproachWork * std::max(0, measured - 1);
}

/// The rows at the pose of now; those that lost their meaning go.
void SurfaceProxy::refreshRows() noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < row_count_; ++i) {
        ContactRow row = rows_[i];
        if (!refresh(row, hulls(row), bodies_[row.body].P)) continue;
        tick_.work += row.fixed ? 1 : 40;
        bool twice = false;
        for (std::size_t k = 0; k < kept && !twice; ++k) twice = rows_[k].isLike(row);
        if (!twice) rows_[kept++] = row;
    }
    row_count_ = kept;
}

/// The gap that is held: an eighth of what two sides leave, where a near plane faces a row that holds.
void SurfaceProxy::adaptGap() noexcept {
    double room = 8.0 * settings_.gap;
    int refined = 0;
    for (std::size_t i = 0; i < row_count_; ++i) {
        const ContactRow& row = rows_[i];
        if (!(row.push > 0.0)) continue;
        const Vec3 across_row = normalOf(row);
        for (std::size_t k = 0; k < near_count_; ++k) {
            NearPair& near = near_[k];
            const KnownBody& body = bodies_[near.body];
            const auto faces = [&] {
                return near.s + row.s < room &&
                       near.n.dot(near.body == row.body ? row.n : body.direction(across_row)) < kOpposite;
            };
            if (!near.faces || !faces()) continue;
            // A plane that proves something need not be the nearest one.
            if (++refined > kMostRefined) return;
            const NearestHulls now = nearestPoints(hulls(near.pair), body.P, near.n, near.seed);
            tick_.work += 5 * now.looks;
            if (now.separation > near.s) {
                near.n = near.n_next = now.n;
                near.s = now.separation;
            }
            const Vec3 across = body.inWorld(now.on_obstacle) - pointOf(row);
            const bool same_place = std::abs(across.dot(across_row)) > kStraight * across.norm();
            if (faces() && same_place) room = near.s + row.s;
        }
    }
    const double wanted = std::max(room / 8.0, kLeastGap);
    gap_ = std::min(wanted, gap_ + kOpening);
}

/// Which of the surfaces that rub a face of a body is of.
std::uint32_t SurfaceProxy::surfaceOf(std::size_t body, std::uint32_t face) const noexcept {
    const auto& firsts = bodies_[body].first_triangles;
    const auto after = std::upper_bound(firsts.begin(), firsts.end(), (*bodies_[body].tree)[face].triangle);
    return static_cast<std::uint32_t>(bodies_[body].first_surface +
                                      static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - firsts.begin(), 1)) -
                                      1);
}

/// Where faces lie on each other, for the torsion of what rubs.
void SurfaceProxy::findTouching() noexcept {
    touching_count_ = 0;
    const double within = kTogether * gap_;
    const auto touches = [&](const NearPair& near) {
        return near.faces && !near.meets && near.s < within && !bodies_[near.body].first_triangles.empty() &&
               lieAlong(hulls(near.pair), bodies_[near.body].P, near.n);
    };
    const auto pairs = std::count_if(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(near_count_), touches);
    const int fineness = pairs <= kFewPairs ? kFinePieces : pairs <= kMorePairs ? 1 : 0;
    tick_.work += static_cast<int>(near_count_ / kLookedOver);
    const int most = tick_.work + budget_ / kTouchingShare;
    for (std::size_t i = 0; i < near_count_ && tick_.work < most; ++i) {
        const NearPair& near = near_[i];
        const KnownBody& body = bodies_[near.body];
        if (!touches(near)) continue;
        const auto room = std::span(touching_).subspan(touching_count_);
        const HullPair pair = hulls(near.pair);
        const std::size_t count = findPieces(pair, body.P, near.n, within, fineness, room);
        tick_.work +=
            10 + 2 * static_cast<int>(pair.of_held.count + pair.of_obstacle.count) + static_cast<int>(count) / 4;
        for (motion::TouchingPiece& piece : room.first(count)) {
            piece.centre = body.inWorld(piece.centre);
            piece.normal = body.directionInWorld(piece.normal);
            piece.obstacle = surfaceOf(near.body, forest_[near.pair].obstacle);
        }
        touching_count_ += count;
    }
}

/// The motion nearest to the hand's that the rows leave.
void SurfaceProxy::solve() noexcept {
    const bool rubs = !friction_.empty() && !overlaps_;
    manifold_.clear();
    std::array<std::uint32_t, 6> likely;
    std::size_t likely_count = 0;
    for (std::size_t i = 0; i < row_count_; ++i) {
        ContactRow& row = rows_[i];
        if (row.push > 0.0 && likely_count < likely.size()) likely[likely_count++] = static_cast<std::uint32_t>(i);
        row.push = 0.0;
        contact::ContactPoint contact{};
        contact.position = pointOf(row);
        contact.gradient = normalOf(row);
        contact.normal = -contact.gradient;
        contact.phi = std::max(row.s - gap_, -ease_) + row.bend;
        if (rubs) {
            contact.phi -= gap_;
            contact.area = 1.0;
            contact.obstacle = surfaceOf(row.body, row.obstacle);
        }
        manifold_.tryPush(contact);
    }
    const std::span<const std::uint32_t> before{likely.data(), likely_count};
    motion::ConstrainedMotion result;
    if (rubs) {
        // A gap more on both sides: what is nearer than two of them touches.
        const motion::Surroundings around{.contacts = manifold_,
                                          .metric = settings_.metric.at(X_),
                                          .keep_out = -gap_,
                                          .pieces = {touching_.data(), touching_count_}};
        const motion::FrictionMotion rubbed =
            motion::constrainWithFriction(wanted_, around, friction_, rubbed_, before);
        result = rubbed.motion;
        patches_ = rubbed.patches;
        tick_.turns = std::max(tick_.turns, rubbed.sweeps);
        tick_.unbalanced = tick_.unbalanced || !rubbed.converged;
        tick_.work += kRubWork * result.iterations + static_cast<int>(touching_count_);
    } else {
        patches_.count = 0;
        result = motion::constrainMotion(wanted_, {manifold_, settings_.metric.at(X_), 0.0}, before);
    }
    u_ = result.u;
    for (int i = 0; i < result.active; ++i) {
        const motion::ActiveContact& active = result.active_contacts[static_cast<std::size_t>(i)];
        rows_[active.contact].push = active.push;
    }
    ++tick_.rounds;
    tick_.work += 20 + static_cast<int>(row_count_) + 8 * result.iterations;
}

/// How many times the rest of the way to go: where rows turn with the pose, each look leaves the same share of a rest,
/// or the next rest is larger. Barzilai, Borwein 1988: of the change of the rest along the last look.
double SurfaceProxy::relaxation() const noexcept {
    const double square = gone_.squaredNorm();
    if (square < kStill * kStill || std::abs(gone_.dot(u_)) < kSameWay * gone_.norm() * u_.norm()) return 1.0;
    const double bent = gone_.dot(rest_before_ - u_) / square;
    return 1.0 / std::clamp(bent, 1.0 / kMostRelaxed, 1.0 / kLeastRelaxed);
}

/// Where triangles cross: out along what faces them, and along the hand, no faster than kFastest.
motion::Motion SurfaceProxy::wayOut() const noexcept {
    Vec3 out = Vec3::Zero();
    for (std::size_t i = 0; i < near_count_; ++i) {
        if (!near_[i].meets) continue;
        const HullPair pair = hulls(near_[i].pair);
        const KnownBody& body = bodies_[near_[i].body];
        out += body.directionInWorld(pair.of_obstacle.normal - body.P.R * pair.of_held.normal);
    }
    motion::Motion u = wanted_;
    const double room = kFastest - way_in_tick_;
    const double length = u.norm();
    if (out.norm() > 1e-6 && length > kPart * room) u *= kPart * room / length;
    if (out.norm() > 1e-6) u.head<3>() += (1.0 - kPart) * room * out.normalized();
    if (u.norm() > room) u *= room / u.norm();
    return u;
}

/// What a look may leave to the next tick [m]: the more, the less of the budget is left.
double SurfaceProxy::goodEnough() const noexcept {
    const double spent = std::min(1.0, static_cast<double>(tick_.work) / static_cast<double>(budget_));
    return std::max(kGoodEnough + spent * spent * kGoodWhenSpent, kGoodShare * way_in_tick_);
}

bool SurfaceProxy::isHeld() const noexcept {
    return std::any_of(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(row_count_),
                       [](const ContactRow& row) { return row.push > 0.0; });
}

/// False if nothing is left to do in this tick.
bool SurfaceProxy::beginLook(const Pose& X_WH) noexcept {
    if (X_WH_.p != X_WH.p || X_WH_.q.coeffs() != X_WH.q.coeffs()) gone_.setZero();
    X_WH_ = X_WH;
    refreshRows();
    if (tick_.looks == 0) {
        adaptGap();
        if (!friction_.empty() && !overlaps_) findTouching();
    }
    ease_ = tick_.looks == 0 ? kEase : 0.0;
    wanted_ = pull_ != nullptr ? pull_->wantedAt(settings_.metric, X_) : settings_.metric.between(X_, X_WH_);
    if (!(most_in_tick_ - way_in_tick_ > kStill)) return false;
    if (overlaps_) {
        wanted_ = wayOut();
        row_count_ = 0;
    }
    solve();
    if (tick_.looks == 0) rubbed_ = patches_;
    rest_ = u_;
    if (const double times = overlaps_ || !friction_.empty() ? 1.0 : relaxation(); times != 1.0) {
        wanted_ += (times - 1.0) * u_;
        solve();
    }
    const bool slow = isHeld() || since_held_ <= kMostIdle || let_go_;
    const double most = slow ? most_held_ : most_in_tick_, left = most - way_in_tick_;
    if (left < kLeastLeft * most) return false;
    const double room = std::min(overlaps_ ? kFastest : trust_, left);
    limited_ = false;
    double length = u_.norm();
    limit(room);
    // What rubs may rest against all rows.
    if (way_ < kCaught && tick_.looks == 0 && friction_.empty() && dropsTwins()) {
        solve();
        length = u_.norm();
        limit(room);
    }
    if (way_ < kStill) return false;
    if (const double share = u_.norm() / length; share < kNearlyWhole) {
        // Rows have to bind where the look ends, so that what they overlook there can be allowed for.
        wanted_ *= share;
        solve();
        limit(room);
    }
    if (tick_.looks > 0 && !limited_ && way_ < goodEnough()) return false;
    most_way_ = std::min(room, 1.3 * way_ + 2e-6);
    lookBack();
    measureNearer();
    wakes_ = 0;
    front_ = at_ = 0;
    front_only_ = false;
    rounds_ = added_ = ghosts_ = shortened_ = 0;
    violated_ = false;
    least_share_ = 1.0;
    phase_ = Phase::Waking;
    return true;
}

/// How much of the look cannot meet a pair that sleeps; 1: all of it.
double SurfaceProxy::shareKnown() const noexcept {
    double share = 1.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const KnownBody& body = bodies_[i];
        if (!body.in_reach) continue;
        for (std::size_t c = 0; c < NormalClass::kCount; ++c) {
            const double room = forest_.sureOf(PairForest::listOf(i, c)) - gap_ - body.common.bent;
            if (body.common.shared && room < body.common.back[c]) return 0.0;
            if (room < share * body.nearer[c]) share = room / body.nearer[c];
        }
    }
    return share;
}

/// Lets all pairs wake that the look may reach, or shortens it. False: the budget ended.
bool SurfaceProxy::wakeAll() noexcept {
    const double more = kMoreShare[std::min(wakes_, kMoreShare.size() - 1)] * most_way_ + kMoreLength;
    ++wakes_;
    for (KnownBody& body : bodies_)
        if (body.in_reach)
            for (std::size_t c = 0; c < NormalClass::kCount; ++c)
                body.ahead[c] = std::min(body.nearer[c] + more, most_way_);
    for (;;) {
        if (!settle()) return false;
        if (shareKnown() >= 1.0) break;
        std::size_t woken = 0;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const KnownBody& body = bodies_[i];
            if (!body.in_reach) continue;
            for (std::size_t c = 0; c < NormalClass::kCount; ++c)
                if (const std::size_t list = PairForest::listOf(i, c);
                    forest_.sureOf(list) < body.due(body.nearer[c], c) + gap_)
                    woken +=
                        forest_.wake(list, body.due(body.ahead[c], c) + gap_, kMostWoken - std::min(woken, kMostWoken));
        }
        if (!settle()) return false;
        const double share = shareKnown();
        if (share >= 1.0) break;
        if (share > 0.5 || share * way_ > kLeastTrust) {
            most_way_ = 0.98 * share * way_;
            limit(most_way_);
            measureNearer();
        }
    }
    phase_ = Phase::Checking;
    return true;
}

/// What the rows' linear motion overlooked at the end of the look, so that the next round allows for it.
void SurfaceProxy::bendRows() noexcept {
    const motion::PlacedMetric here = settings_.metric.at(X_);
    const Vec3 turn = here.turnOf(u_);
    for (std::size_t i = 0; i < row_count_; ++i) {
        ContactRow& row = rows_[i];
        const double linear = row.s + normalOf(row).dot(Vec3(u_.head<3>() + turn.cross(pointOf(row) - here.centre)));
        row.bend = std::min(0.0, row.gapAt(bodies_[row.body].P_next) - linear);
    }
}

/// One more round of a look. False: what was proven is to be accepted, or nothing was found, and the look is over.
bool SurfaceProxy::tryAgain(bool violated) noexcept {
    ++rounds_;
    bool shorten = rounds_ > kMostRounds;
    const motion::Motion before = u_;
    if (!shorten) {
        if (violated) bendRows();
        solve();
        limit(most_way_);
        shorten = (u_ - before).norm() <= kStill;
    }
    if (shorten && !violated) {
        u_ = before;
        limit(most_way_);
        measureNearer();
        return false;
    }
    if (shorten) {
        rounds_ = std::max(rounds_, kMostRounds);
        u_ *= std::clamp(0.9 * least_share_, 0.1, 0.7);
        limited_ = true;
        limit(most_way_);
        if (way_ < kStill || rounds_ > kMostRounds + kMostShorter) {
            phase_ = Phase::Idle;
            return false;
        }
    }
    at_ = 0;
    front_only_ = true;
    violated_ = false;
    added_ = 0;
    least_share_ = 1.0;
    measureNearer();
    if (shareKnown() < 1.0) phase_ = Phase::Waking;  // it goes another way now
    return true;
}

HullPair SurfaceProxy::hulls(const ContactRow& row) const noexcept {
    const ClusterTree& tree = *bodies_[row.body].tree;
    return {*held_, tree, (*held_)[row.held], tree[row.obstacle]};
}

/// True if a row's faces are far from each other at a pose at which their planes are not, or what it holds is not over
/// its face: it is one beyond their ends.
bool SurfaceProxy::isGhost(const ContactRow& row, const Placement& X) noexcept {
    const HullPair pair = hulls(row);
    ++tick_.work;
    if (!isOverItsFace(row, pair, X)) return true;
    const double far = 1.5 * std::max(row.gapAt(X), gap_) + kLeastGap;
    const NearestHulls there = nearestHulls(pair, X, row.n, far, far);
    tick_.work += 5 * there.looks;
    return there.separation >= far;
}

/// Rows that hold although they are ghosts go. True if there were any.
bool SurfaceProxy::dropsGhosts() noexcept {
    ++ghosts_;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < row_count_; ++i) {
        const ContactRow& row = rows_[i];
        if (!(row.push > 0.0) || !isGhost(row, bodies_[row.body].P_next)) rows_[kept++] = row;
    }
    const bool any = kept < row_count_;
    row_count_ = kept;
    return any;
}

/// Where two planes that hold almost face the same way, the one that bears less goes. Around an edge planes turn within
/// the gap, so that one that leans may bar a way that the faces leave: a look has to tell. True if there were any.
bool SurfaceProxy::dropsTwins() noexcept {
    std::size_t kept = 0;
    const auto hasStronger = [&](std::size_t i) {
        for (std::size_t k = 0; k < row_count_; ++k)
            if (rows_[k].push > rows_[i].push && rows_[k].body == rows_[i].body && rows_[k].n.dot(rows_[i].n) > kTwins)
                return true;
        return false;
    };
    std::array<bool, kMostRows> goes{};
    for (std::size_t i = 0; i < row_count_; ++i) goes[i] = rows_[i].push > 0.0 && !rows_[i].fixed && hasStronger(i);
    for (std::size_t i = 0; i < row_count_; ++i)
        if (!goes[i]) rows_[kept++] = rows_[i];
    const bool any = kept < row_count_;
    row_count_ = kept;
    return any;
}

const SurfaceTick& SurfaceProxy::advance(const Pose& X_WH, const motion::Pull* pull) noexcept {
    pull_ = pull;
    tick_ = {};
    tick_.work = std::min(std::exchange(owed_, 0), budget_ / 2);
    chain_count_ = 0;
    const Pose& X_hand = X_WH_told_ ? *X_WH_told_ : X_WH;
    const bool balanced = X_hand.p != X_WH.p || X_hand.q.coeffs() != X_WH.q.coeffs();
    const double hand_way = X_WH_last_ ? wayBetween(Placement(*X_WH_last_), Placement(X_hand)) : 0.0;
    X_WH_last_ = X_hand;
    if (left_to_lead_ > 0.0) return lead();
    const double swept = std::exchange(swept_, 0.0);
    const double others_way = X_WH_told_ ? hand_way + others_way_ : std::max(hand_way, swept);
    trust_ = hurry_ * std::max({kLeastTrust, 1.5 * hand_way, std::min(2.0 * last_way_, kFastest)});
    most_in_tick_ = overlaps_ ? kFastest : std::max(kFastest, 1.5 * others_way);
    most_held_ = std::min(most_in_tick_, std::max(kFastestHeld, 1.5 * others_way));
    way_in_tick_ = 0.0;
    findReach();
    if (phase_ == Phase::Idle) {
        for (KnownBody& body : bodies_)
            if (body.in_reach) body.ahead.fill(0.0);
        if (!catchUp() || !settle() || !knowsItsSide()) tick_.suspended = true;
        if (left_to_lead_ > 0.0) return lead();
    }
    while (!tick_.suspended && static_cast<std::size_t>(tick_.looks) < kMostLooks) {
        if (phase_ == Phase::Idle && asks_ && !overlaps_) break;
        if (phase_ == Phase::Idle && !beginLook(X_WH)) break;
        if (phase_ == Phase::Waking && !wakeAll()) tick_.suspended = true;
        if (phase_ != Phase::Checking) continue;
        const Checked checked = check();
        // Another motion with friction takes long.
        if (checked == Checked::Spent || (checked == Checked::Violated && !friction_.empty() && spent())) {
            tick_.suspended = true;
        } else if (checked == Checked::Astray) {
            if (!shorten()) break;
        } else if (checked == Checked::Violated ||
                   (ghosts_ < kMostGhosts && !tick_.waits && 2 * tick_.work < budget_ && dropsGhosts())) {
            if (tryAgain(checked == Checked::Violated)) continue;
            if (phase_ == Phase::Idle) {
                tick_.stuck = true;
                break;
            }
            accept();
        } else {
            accept();
            if (tick_.waits || (!limited_ && way_ < goodEnough())) break;
        }
    }
    if (!tick_.suspended) {
        last_way_ = way_in_tick_;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < row_count_; ++i) {
            // Who asked for a pose between the hands counts on rows that hold nothing there.
            const bool counted = balanced && rows_[i].gapAt(bodies_[rows_[i].body].P) <= kSeen;
            rows_[i].idle = rows_[i].push > 0.0 || counted ? 0 : rows_[i].idle + 1;
            if (rows_[i].idle <= kMostIdle) rows_[kept++] = rows_[i];
        }
        row_count_ = kept;
        if (isHeld()) refineLeast();
    }
    tell();
    let_go_ = let_go_ && (pressed_ || wayBetween(P_, Placement(X_WH)) > kFastestHeld);
    if (tick_.active > 0)
        since_held_ = 0;
    else if (!tick_.suspended && !tick_.waits)
        since_held_ = std::min(since_held_ + 1, kMostIdle + 1);
    return tick_;
}

/// A plane that proved enough need not be the nearest one, nor need what sleeps be as near as it may: of those that
/// would be told the distances are found out.
void SurfaceProxy::refineLeast() noexcept {
    double told = kSeen;
    const auto refine = [&](NearPair& near) {
        const NearestHulls now = nearestPoints(hulls(near.pair), bodies_[near.body].P, near.n, near.seed);
        tick_.work += 5 * now.looks;
        if (now.separation > near.s) {
            near.n = near.n_next = now.n;
            near.s = now.separation;
        }
    };
    const auto end = near_.begin() + static_cast<std::ptrdiff_t>(near_count_);
    const auto least = std::min_element(near_.begin(), end, [](const NearPair& a, const NearPair& b) {
        return (a.faces ? a.s : kUnlimited) < (b.faces ? b.s : kUnlimited);
    });
    if (least != end && least->faces && !least->meets) {
        refine(*least);
        told = std::min(told, least->s);
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        for (std::size_t c = 0; bodies_[i].in_reach && c < NormalClass::kCount; ++c)
            if (const std::size_t list = PairForest::listOf(i, c); forest_.sureOf(list) < told)
                forest_.wake(list, told, kMostWoken);
    if (!settle()) return;
    for (std::size_t i = 0; i < near_count_ && !spent();) {
        NearPair& near = near_[i];
        if (near.s + kTold < told && !near.meets) {
            refine(near);
            if (near.faces)
                told = std::min(told, near.s);
            else if (near.s < told && trySplit(i))
                continue;
        }
        ++i;
    }
}

void SurfaceProxy::tell() noexcept {
    tick_.work += static_cast<int>(near_count_ / kLookedOver);
    double least = kUnlimited;
    overlaps_ = false;
    for (std::size_t i = 0; i < near_count_; ++i) {
        least = std::min(least, near_[i].s);
        overlaps_ = overlaps_ || near_[i].meets;
    }
    least_ = least;
    tick_.X_WG = X_;
    double proven = std::min(least, kSeen);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        for (std::size_t c = 0; bodies_[i].in_reach && c < NormalClass::kCount; ++c)
            proven = std::min(proven, bodies_[i].settled[c] - forest_.travelledOf(PairForest::listOf(i, c)));
    tick_.gap = std::max(0.0, proven - kTold);
    tick_.meets = overlaps_;
    tick_.rows = static_cast<int>(row_count_);
    for (std::size_t i = 0; i < row_count_; ++i)
        if (const Placement& X = bodies_[rows_[i].body].P;
            rows_[i].push > 0.0 && rows_[i].gapAt(X) <= kTouches * gap_ && !isGhost(rows_[i], X))
            ++tick_.active;
}

double SurfaceProxy::handDepth(const Pose& X_WH) const noexcept {
    double depth = 0.0;
    const Placement hand(X_WH);
    for (const ContactRow& row : rows()) {
        if (!(row.push > 0.0)) continue;
        const Vec3 point = pointOf(row);
        depth = std::max(depth, normalOf(row).dot(point - hand * (P_.R.transpose() * (point - P_.p))));
    }
    return depth;
}

}  // namespace passung::surface
