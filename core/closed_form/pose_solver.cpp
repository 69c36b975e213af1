#include "core/closed_form/pose_solver.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/motion/active_set.h"

namespace passung::closed_form {

namespace {

constexpr double kSamePlace = 0.5;       // of a line's parameter: a contact that held is that one now
constexpr int kMostTaken = 60;           // rows taken up or let go in a look
constexpr double kAlongRidge = 0.3;      // of a unit motion: what contacts leave of it
constexpr double kOffRidge = 4e-6;       // [m]
constexpr int kMostReleases = 4;         // of rows that were made stiff, in a look
constexpr double kRowTolerance = 1e-12;  // [m]
constexpr double kMostLean = 0.02;       // [rad]

/// B = L Lᵀ. False: some of B is not stiff enough.
bool isStiff(const MotionMatrix& B, MotionMatrix& L) noexcept {
    const Eigen::LLT<MotionMatrix> chol(B);
    if (chol.info() != Eigen::Success || !(chol.matrixLLT().diagonal().cwiseAbs2().minCoeff() > kLeastStiffness))
        return false;
    L = chol.matrixL();
    return true;
}

/// L⁻¹ v. Of the unit matrix that is v to the bit, but for the signs of zeros.
motion::Motion solved(const MotionMatrix& L, bool bent, const motion::Motion& v) noexcept {
    if (!bent && (v.array() != 0.0).all()) return v;
    return L.triangularView<Eigen::Lower>().solve(v);
}

}  // namespace

PoseSolver::PoseSolver(std::span<const SolidPair> pairs, geometry::NearList near,
                       std::span<const motion::Friction> friction)
    : near_(std::move(near)),
      rows_(pairs.empty() ? 0 : kMostRows),
      prepared_(rows_.size()),
      friction_(friction.begin(), friction.end()),
      manifold_(friction.empty() ? 0 : kMostRows) {
    if (near_.hasAll()) {
        all_.resize(pairs.size());
        std::iota(all_.begin(), all_.end(), 0u);
    }
    if (!pairs.empty()) metric_ = pairs.front().metric;
    for (const SolidPair& pair : pairs) {
        meetings_.push_back(static_cast<int>(searches_.emplace_back(pair).meetings()));
        reach_ = std::max(reach_, reachOf(*pair.held));
        sight_ = std::min({sight_, sightOf(*pair.held), sightOf(*pair.obstacle)});
        longest_way_ = std::min({longest_way_, 0.5 * thicknessOf(*pair.held), 0.5 * thicknessOf(*pair.obstacle)});
    }
}

void PoseSolver::measureBy(const motion::Metric& metric) noexcept {
    metric_ = metric;
    for (ContactSearch& search : searches_) search.measureBy(metric);
    X_found_.reset();
}

void PoseSolver::add(const Row& row) noexcept {
    if (count_ < rows_.size())
        rows_[count_++] = row;
    else
        full_ = true;
}

double PoseSolver::reachFor(const motion::Motion& wanted) const noexcept {
    if (near_.hasAll()) return std::numeric_limits<double>::infinity();
    const double way = wayOf(wanted);
    double reach = kLeastNear;
    while (reach < kNearWays * way) reach *= 2.0;
    return reach;
}

/// No point of the held part goes farther.
double PoseSolver::wayOf(const motion::Motion& u) const noexcept {
    return u.head<3>().norm() + (reach_ + metric_.distance()) / metric_.radius * u.tail<3>().norm();
}

/// What the last look of a tick has found holds for the first one of the next.
void PoseSolver::find(const Pose& X, double reach) noexcept {
    if (isFound(X) && !(reach > found_reach_)) {
        count_ = found_;
        for (std::size_t i = 0; i < count_; ++i) {
            rows_[i].from.push = 0.0;
            rows_[i].stiff = false;
        }
        return;
    }
    X_found_ = X;
    count_ = 0;
    overlap_ = 0.0;
    free_ = found_reach_ = reach;
    full_ = false;
    int meetings = 1;
    const std::span<const std::uint32_t> near =
        near_.hasAll() ? std::span<const std::uint32_t>(all_) : near_.within(X, reach);
    for (const std::uint32_t p : near) {
        meetings += meetings_[p];
        free_ = std::min(free_, searches_[p].find(X, sight_, contacts_, memory_, kMostLean));
        overlap_ = std::max(overlap_, searches_[p].foundOverlap());
        full_ = full_ || contacts_.full();
        for (const Contact& contact : contacts_.all())
            add({.from = {.contact = contact, .pair = static_cast<std::uint16_t>(p)},
                 .slides = contact.touch.kind != Touch::Kind::Fixed});
    }
    found_ = count_;
    most_looks_ = std::clamp(kMostMeetings / meetings, kFewestLooks, kMostLooks);
}

double PoseSolver::distance(const Contact& contact, const HeldContact& old) const noexcept {
    const TouchName& name = old.contact.name;
    const SmoothSolid& lines = name.of_held ? *pair(old.pair).held : *pair(old.pair).obstacle;
    const Curve& line = (name.core ? lines.cores : lines.edges)[name.line];
    return apartOn(line, contact.touch.t, old.contact.touch.t);
}

PoseSolver::Row* PoseSolver::successorOf(const HeldContact& old) noexcept {
    Row* best = nullptr;
    double least = kSamePlace;
    for (std::size_t i = 0; i < found_; ++i) {
        Row& row = rows_[i];
        if (row.from.pair != old.pair || !(row.from.contact.name == old.contact.name)) continue;
        const double d = distance(row.from.contact, old) + (row.slides ? 0.0 : 1e-3);
        if (d >= least) continue;
        least = d;
        best = &row;
    }
    return best;
}

/// What held in the look before pushes as its successor does now, and stays where it was for a while.
void PoseSolver::remember(const Pose& X, const PoseMemory& memory) noexcept {
    for (const HeldContact& old : memory.all()) {
        Row* now = successorOf(old);
        if (now != nullptr) now->from.push += old.push;
        if ((now != nullptr && distance(now->from.contact, old) < kSameTouch) || old.age >= kKeptLooks) continue;
        const auto there = keptAt(pair(old.pair), X, old.contact);
        if (!there || there->gap >= sight_ || there->lean > kMostLean) continue;
        Row kept{.from = old, .slides = false};
        kept.from.contact = *there;
        kept.from.age = old.age + 1;
        if (now != nullptr) kept.from.push = 0.0;
        add(kept);
    }
}

/// B = L Lᵀ; `wanted` becomes what it is for that B. False: it is 1, nothing bends it.
bool PoseSolver::factor(const Pose& X, MotionMatrix& L, motion::Motion& wanted) noexcept {
    MotionMatrix B = MotionMatrix::Identity(), along_rows = MotionMatrix::Zero();
    motion::Motion to_rows = motion::Motion::Zero();
    bool bent = false;
    ridge_ = motion::Motion::Zero();
    for (std::size_t i = 0; i < count_; ++i) {
        const HeldContact& from = rows_[i].from;
        if (!(from.push > 0.0)) continue;
        bent = true;
        B -= from.push * curvatureOf(pair(from.pair), X, from.contact, rows_[i].slides);
        const motion::Motion& a = from.contact.a;
        const double gap = from.contact.gap + allowed_;
        rows_[i].stiff = std::abs(gap) < kHeldGap;
        if (!rows_[i].stiff) continue;
        const double stiffness = kHeldStiffness / a.squaredNorm();
        along_rows += stiffness * a * a.transpose();
        to_rows -= stiffness * gap * a;
    }
    L = B;
    if (!bent || isStiff(B, L)) {
        for (std::size_t i = 0; i < count_; ++i) rows_[i].stiff = false;
        return bent;
    }
    B += along_rows;
    wanted += to_rows;
    if (isStiff(B, L)) return true;
    const Eigen::SelfAdjointEigenSolver<MotionMatrix> eigen(B);
    if (eigen.eigenvalues()[0] < 0.0) ridge_ = eigen.eigenvectors().col(0);
    const motion::Motion values = eigen.eigenvalues().cwiseMax(kLeastStiffness);
    B = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
    L = Eigen::LLT<MotionMatrix>(B).matrixL();
    return true;
}

/// Of the rows as they are prepared; pushes are per contact's normal.
bool PoseSolver::solveRows(const motion::Motion& wanted, motion::ConstrainedMotion& found) noexcept {
    motion::ActiveSet active;
    motion::Motion& y = found.u;
    for (std::size_t i = 0; i < count_; ++i)
        if (rows_[i].from.push > 0.0) active.tryAdd(prepared_[i], 0.0);
    y = active.start(wanted);
    int taken = 0;
    for (;;) {
        const motion::MotionRow* worst = nullptr;
        double most = kRowTolerance;
        for (std::size_t i = 0; i < count_; ++i) {
            const double violated = prepared_[i].bound - prepared_[i].a.dot(y);
            if (violated <= most) continue;
            most = violated;
            worst = &prepared_[i];
        }
        if (worst == nullptr) break;
        if (active.takeUp(*worst, y, taken, kMostTaken) != motion::ActiveSet::Taken::Yes) return false;
    }
    found.active = active.size();
    for (int i = 0; i < found.active; ++i) {
        const motion::MotionRow& row = active.row(i);
        found.active_contacts[static_cast<std::size_t>(i)] = {row.contact, active.lambda(i) / row.length};
    }
    return true;
}

/// What friction leaves of the motion that was found.
void PoseSolver::rub(const Pose& X, const motion::Motion& wanted, const MotionMatrix* unbent,
                     const motion::FrictionPatches& before, motion::ConstrainedMotion& found) noexcept {
    manifold_.clear();
    for (std::size_t i = 0; i < count_; ++i) {
        const HeldContact& from = rows_[i].from;
        manifold_.tryPush({.position = from.contact.point,
                           .normal = from.contact.normal,
                           .gradient = from.contact.normal,
                           .phi = from.contact.gap - kHeldGap,
                           .area = 1.0,
                           .obstacle = from.pair});
    }
    const auto lengthOf = [&](const motion::ActiveContact& held) { return manifold_[held.contact].gradient.norm(); };
    // Nearer to what will hold than what does without friction.
    motion::ConstrainedMotion held_before;
    held_before.relaxed = found.relaxed;
    for (std::size_t i = 0; i < count_ && held_before.active < 6; ++i)
        if (rows_[i].from.push > 0.0)
            held_before.active_contacts[static_cast<std::size_t>(held_before.active++)] = {
                static_cast<std::uint32_t>(i), rows_[i].from.push};
    if (held_before.active > 0) found = held_before;
    for (int i = 0; i < found.active; ++i) {
        motion::ActiveContact& held = found.active_contacts[static_cast<std::size_t>(i)];
        held.push *= lengthOf(held);
    }
    const double keep_out = -allowed_ - kHeldGap;
    const motion::Surroundings around{
        .contacts = manifold_, .metric = metric_.at(X), .keep_out = keep_out, .sunk_out = keep_out, .unbent = unbent};
    const motion::FrictionMotion rubbed = motion::balanceFriction(wanted, around, friction_, before, found);
    rubs_ += rubbed.motion.iterations;
    found = rubbed.motion;
    patches_ = rubbed.patches;
    for (int i = 0; i < found.active; ++i) {
        motion::ActiveContact& held = found.active_contacts[static_cast<std::size_t>(i)];
        held.push /= lengthOf(held);
    }
}

/// The rows with L: a_i L⁻ᵀ.
void PoseSolver::prepare(const MotionMatrix& L, bool bent) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const motion::Motion a = solved(L, bent, rows_[i].from.contact.a);
        const double length = a.norm();
        prepared_[i].a = a / length;
        prepared_[i].length = length;
        prepared_[i].contact = static_cast<std::uint32_t>(i);
        prepared_[i].bound = -(rows_[i].from.contact.gap + allowed_) / length;
    }
}

/// Lets go of rows that were made stiff and that do not hold: beside one nothing could move away from it. True: of
/// some.
bool PoseSolver::releaseStiff(const motion::ConstrainedMotion& found) noexcept {
    for (int i = 0; i < found.active; ++i)
        rows_[found.active_contacts[static_cast<std::size_t>(i)].contact].stiff = false;
    bool any = false;
    for (std::size_t i = 0; i < count_; ++i) {
        if (!rows_[i].stiff) continue;
        rows_[i].stiff = false;
        rows_[i].from.push = 0.0;
        any = true;
    }
    return any;
}

/// The motion that the rows leave of `wanted`; what holds it is held from now on. `back`: B is 1.
motion::Motion PoseSolver::step(const Pose& X, const motion::Motion& wanted, bool back, PoseMemory& memory) noexcept {
    MotionMatrix L = MotionMatrix::Identity();
    motion::ConstrainedMotion found;
    if (!back) patches_ = {};
    for (int round = 0;; ++round) {
        motion::Motion way = wanted;
        const bool bent = !back && factor(X, L, way);
        prepare(L, bent);
        const motion::Motion there = solved(L, bent, way);
        found.relaxed = !solveRows(there, found);
        if (found.relaxed) {
            for (std::size_t i = 0; i < count_; ++i) prepared_[i].bound = std::min(prepared_[i].bound, 0.0);
            if (!solveRows(there, found)) return motion::Motion::Zero();
        }
        if (!friction_.empty() && !back && found.active > 0) {
            const MotionMatrix unbent = L.triangularView<Eigen::Lower>().solve(MotionMatrix::Identity());
            rub(X, there, bent ? &unbent : nullptr, memory.rubbing, found);
        }
        if (!releaseStiff(found) || round == kMostReleases) break;
    }
    memory.count = static_cast<std::size_t>(found.active);
    for (std::size_t i = 0; i < memory.count; ++i) {
        const motion::ActiveContact& held = found.active_contacts[i];
        memory.held[i] = rows_[held.contact].from;
        memory.held[i].push = held.push;
    }
    return L.transpose().triangularView<Eigen::Upper>().solve(found.u);
}

/// What of a look's motion is safe to make.
motion::Motion PoseSolver::shortened(const motion::Motion& u) const noexcept {
    const double way = wayOf(u);
    if (way < free_) return u;
    const double turn = u.tail<3>().norm() / metric_.radius;
    const double rise = (reach_ + metric_.distance()) * turn * turn / 8.0;
    const double share = std::min({longest_way_ / way, kLongestLook / u.norm(), std::sqrt(kMostRise / rise)});
    return std::min(1.0, std::max(share, free_ / way)) * u;
}

/// Where the energy has no minimum but a ridge, as where two edges pass each other: off it, the way that the tick went.
motion::Motion PoseSolver::offRidge(const motion::Motion& way, const PoseMemory& memory) const noexcept {
    motion::Motion v = ridge_;
    if (v.squaredNorm() == 0.0) return v;
    for (int round = 0; round < 8; ++round)
        for (const HeldContact& held : memory.all())
            v -= v.dot(held.contact.a) / held.contact.a.squaredNorm() * held.contact.a;
    if (v.norm() < kAlongRidge) return motion::Motion::Zero();
    return (v.dot(way) < 0.0 ? -kOffRidge : kOffRidge) * v.normalized();
}

ConstrainedPose PoseSolver::solve(const Pose& X_WG, const Pose& X_WH, PoseMemory& memory, int most,
                                  const motion::Pull* pull) noexcept {
    ConstrainedPose result{.X_WG = X_WG};
    way_.clear();
    Pose X = X_WG;
    double last = std::numeric_limits<double>::infinity();  // length of the last look's motion
    double astray = 0.0;                                    // of the motions since the last pose that counts
    bool left = false;                                      // a ridge
    rubs_ = 0;
    for (int i = 0;; ++i) {
        const motion::Motion wanted = pull != nullptr ? pull->wantedAt(metric_, X) : metric_.between(X, X_WH);
        find(X, reachFor(wanted));
        if (i == 0) most = std::min(most, most_looks_);
        if (i == 0) allowed_ = std::max(0.0, overlap_ - kRepair);
        const bool kept = overlap_ <= allowed_ + kKeptOverlap;
        if (kept || i == 0) {
            way_.add(X);
            result.X_WG = X;
            result.overlap = overlap_;
            result.full = full_;
            result.pull = wanted;
            astray = 0.0;
        }
        result.converged = kept && last <= kStillMoving;
        if (result.converged || i == most || rubs_ > kMostRubs) return result;
        result.iterations = i + 1;
        remember(X, memory);
        const bool back = !kept && astray > kMostAstray;
        PoseMemory aside = memory;
        motion::Motion u = back ? step(X, motion::Motion::Zero(), true, aside) : step(X, wanted, false, memory);
        if (!left && kept && u.norm() <= kStillMoving && friction_.empty()) {
            const motion::Motion off = offRidge(metric_.between(X_WG, X), memory);
            left = off.squaredNorm() > 0.0;
            u += off;
        }
        const motion::Motion made = shortened(u);
        last = back ? std::numeric_limits<double>::infinity() : u.norm();
        if (i == 0 || (!back && last > kStillMoving)) memory.rubbing = patches_;
        astray += back ? 0.0 : made.norm();
        X = metric_.moved(X, made);
    }
}

}  // namespace passung::closed_form
