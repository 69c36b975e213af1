#include "tests/hard/found_onlooker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/hard/figures.h"

namespace passung::hard {

namespace {

constexpr std::size_t kWayEvery = 5;   // ticks, in the short version on triangles
constexpr std::size_t kGapEvery = 20;  // ticks
constexpr std::size_t kForceEvery = 20;
constexpr std::size_t kMostLags = 60;  // ticks in the short version: without a cap one may take a second
constexpr int kBetween = 9;            // poses between two accepted ones
constexpr double kFar = 2e-5;          // [m]: farther gaps are not told apart
constexpr double kAway = 1e-3;         // of the held part's reach
constexpr double kAfterSuspended = 2;  // ticks whose steps are the suspension's
constexpr double kInserted = 1.2;      // [s]: the tilted peg is in its bore
constexpr double kCaught = 4e-5;       // [m]: it does not follow along its axis

DenseDistance distanceOf(const scene::SceneSpec& spec) {
    Run run;
    run.spec = run.solids = spec;
    return denseDistance(run);
}

/// The largest way of any corner of the held part's box.
double wayBetween(const geometry::Bounds& box, const Pose& from, const Pose& to) {
    double most = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 c(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                     i & 4 ? box.high.z() : box.low.z());
        most = std::max(most, (to * c - from * c).norm());
    }
    return most;
}

}  // namespace

void Seen::take(const Seen& more) {
    for (std::size_t Seen::*sum : {&Seen::ticks, &Seen::poses, &Seen::pressed, &Seen::crossings, &Seen::between,
                                   &Seen::gaps_too_high, &Seen::gaps, &Seen::gaps_loose, &Seen::suspended,
                                   &Seen::hanging, &Seen::not_finite, &Seen::catches, &Seen::referenced})
        this->*sum += more.*sum;
    for (double Seen::*most : {&Seen::overlap, &Seen::overlap_between, &Seen::lag, &Seen::step, &Seen::beyond,
                               &Seen::sent, &Seen::axial, &Seen::speed, &Seen::off})
        this->*most = std::max(this->*most, more.*most);
    suspended_in_a_row = std::max(suspended_in_a_row, more.suspended_in_a_row);
}

FoundOnlooker::FoundOnlooker(const Found& found, const FoundScene& scene, bool full)
    : found_(found), scene_(scene), full_(full), reference_(scene.spec) {
    if (!scene.held.triangles.empty()) {
        triangles_.emplace(scene.held, scene.obstacle);
        return;
    }
    shown_.reset(new DenseDistance(distanceOf(scene.spec)));
    way_.reset(new DenseDistance(distanceOf(scene.spec)));
}

void FoundOnlooker::look(const tick::HandModel& model, const tick::HandState& state, const tick::TickOutput& output) {
    const tick::TickFrame& frame = output.frame;
    ++seen_.ticks;
    if (!isFinite(output.X_WG) || !isFinite(output.F_D_B)) {
        ++seen_.not_finite;
        return;
    }
    if (frame.contacts > 0 || (frame.status & kSuspended) != 0) ++seen_.pressed;
    lookAtLag(model, output);
    if (full_ || tick_ % found_.way_every == 0) lookAtWay(model, state);
    judgePose(output.X_WG, false);
    if (triangles_ && tick_ % kGapEvery == 0) lookAtGap(output);
    lookAtForce(model, output);
    X_WH_ = frame.X_WH;
    X_WG_ = output.X_WG;
    ++tick_;
}

void FoundOnlooker::lookAtWay(const tick::HandModel& model, const tick::HandState& state) {
    if (tick_ == 0) return;
    Pose from = X_WG_;
    for (const Pose& to : model.hasSurfaces() ? state.surface->chain() : state.solver.way()) {
        for (int k = 1; k <= kBetween; ++k) {
            const double share = static_cast<double>(k) / (kBetween + 1);
            judgePose({from.q.slerp(share, to.q), from.p + share * (to.p - from.p)}, true);
        }
        judgePose(to, true);
        from = to;
    }
}

void FoundOnlooker::judgePose(const Pose& X, bool between) {
    ++seen_.poses;
    if (triangles_) {
        if (triangles_->distance(X, 1e-9) == 0.0) ++(between ? seen_.between : seen_.crossings);
        return;
    }
    double& deepest = between ? seen_.overlap_between : seen_.overlap;
    deepest = -(between ? way_ : shown_)->least(X, -deepest);
}

/// What is told of the gap, and whether the proxy stays away from the hand where nothing holds it.
void FoundOnlooker::lookAtGap(const tick::TickOutput& output) {
    const tick::TickFrame& frame = output.frame;
    const double exact = triangles_->distance(output.X_WG, kFar);
    const bool suspended = (frame.status & kSuspended) != 0;
    if (frame.proxy_gap > exact) ++seen_.gaps_too_high;
    if (frame.contacts > 0 && !suspended) {
        ++seen_.gaps;
        if (exact > 1.1 * frame.proxy_gap + 2e-7) ++seen_.gaps_loose;
    }
    const double reach = geometry::boundsOf(scene_.held).size().norm();
    const bool hangs = !suspended && exact >= kFar && (output.X_WG.p - frame.X_WH.p).norm() > kAway * reach;
    if (hangs && hung_) ++seen_.hanging;
    hung_ = hangs;
}

void FoundOnlooker::lookAtForce(const tick::HandModel& model, const tick::TickOutput& output) {
    const Pose &X_WH = output.frame.X_WH, &X_WG = output.X_WG;
    const double K = model.contact.stiffness;
    const Vec3 spring = K * (X_WG.p - X_WH.p), sent = output.frame.F_H_W.force;
    since_suspended_ = (output.frame.status & kSuspended) ? 0 : since_suspended_ + 1;
    if (tick_ > 0) {
        seen_.speed = std::max(seen_.speed, (X_WH.p - X_WH_.p).norm() / kTickSeconds);
        if (static_cast<double>(since_suspended_) > kAfterSuspended) {
            const double hand = std::hypot((X_WH.p - X_WH_.p).norm(),
                                           model.metric_radius * rotationVector(X_WH.q * X_WH_.q.conjugate()).norm());
            const double step = (spring - spring_).norm();
            if (static_cast<double>(tick_) * kTickSeconds > kInserted) seen_.step = std::max(seen_.step, step);
            seen_.beyond = std::max(seen_.beyond, step - K * hand);
            seen_.sent = std::max(seen_.sent, (sent - sent_).norm());
        }
    }
    spring_ = spring;
    sent_ = sent;
    if (found_.most_axial > 0.0 && static_cast<double>(tick_) * kTickSeconds > kInserted) {
        seen_.axial = std::max(seen_.axial, std::abs(spring.z()));
        const bool caught = std::abs(X_WG.p.z() - X_WH.p.z()) > kCaught;
        if (caught && !caught_) ++seen_.catches;
        caught_ = caught;
    }
    if (found_.most_off > 0.0 && reference_.missing().empty() && tick_ % kForceEvery == 0) {
        if (const auto force = reference_.at(X_WG, X_WH)) {
            ++seen_.referenced;
            seen_.off = std::max(seen_.off, (spring - *force).norm());
        }
    }
}

/// How far the proxy stays behind one without a cap, which begins anew where the last look was finished.
void FoundOnlooker::lookAtLag(const tick::HandModel& model, const tick::TickOutput& output) {
    if (!(output.frame.status & kSuspended)) {
        suspended_ = 0;
        return;
    }
    ++seen_.suspended;
    seen_.suspended_in_a_row = std::max(seen_.suspended_in_a_row, ++suspended_);
    if (found_.may_be_suspended) {
        seen_.lag = std::max(seen_.lag, wayBetween(model.held_surface->box(), output.X_WG, output.frame.X_WH));
        return;
    }
    if (!full_ && lags_ >= kMostLags) return;
    ++lags_;
    if (!unlimited_)
        unlimited_.emplace(*model.held_surface, *model.still_surface,
                           surface::SurfaceSettings{.metric = motion::Metric{model.metric_radius},
                                                    .gap = tick::kSurfaceGap,
                                                    .budget = std::numeric_limits<int>::max() / 2});
    if (suspended_ == 1) {
        unlimited_->place(X_WG_);
        unlimited_->prepare();
    }
    const Pose there = unlimited_->advance(output.frame.X_WH).X_WG;
    seen_.lag = std::max(seen_.lag, wayBetween(model.held_surface->box(), output.X_WG, there));
}

}  // namespace passung::hard
