#include "core/loop/stiffness_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace passung::loop {

namespace {

constexpr std::int64_t kSettleTicks = 300, kPressTicks = 600, kRampTicks = 300, kIdleTicks = 600;
constexpr std::int64_t kStretchTicks = 200;  // of the idle phase: the first and the last so many are compared
constexpr double kPress = 0.8;               // of the force limit
constexpr double kPressTravel = 0.4;         // of the way allowed, the most that a soft spring is pressed by
// Of what the press stored, the most that the spring may give the handle while it swings. Near the border it gives what
// the mechanism's own damping takes, several times that.
constexpr double kMostGiven = 10.0;
constexpr double kMostDemand = 2.0;  // of the limit, before it cuts
constexpr double kEnoughGrowth = 1.01;
constexpr double kPeak = 4.0;  // encoder steps of a peak that counts
constexpr int kFewestPairs = 3;
constexpr double kSpread = 0.05;  // of the peaks, about their mean
constexpr double kRest = 3.0;     // encoder steps of deviation that count as rest

}  // namespace

StiffnessSearch::StiffnessSearch(const StiffnessSearchParams& params)
    : params_(params), step_(std::numeric_limits<double>::infinity()) {
    begin(params.first);
}

void StiffnessSearch::enter(Phase phase) noexcept {
    phase_ = phase;
    ticks_ = 0;
}

void StiffnessSearch::begin(double stiffness) noexcept {
    stiffness_ = stiffness;
    axis_ = 0;
    enter(Phase::Settle);
}

/// All axes were calm.
void StiffnessSearch::judge() noexcept {
    calm_ = stiffness_;
    if (unstable_ > 0.0) {
        while (calm_ * growth_ >= unstable_ && growth_ > kEnoughGrowth) growth_ = std::sqrt(growth_);
        if (growth_ <= kEnoughGrowth) return enter(Phase::Finished);
    } else if (stiffness_ >= params_.highest) {
        return enter(Phase::Finished);
    }
    begin(std::min(calm_ * growth_, params_.highest));
}

void StiffnessSearch::fail() noexcept {
    unstable_ = stiffness_;
    if (!(calm_ > 0.0)) return enter(Phase::Finished);
    growth_ = std::sqrt(growth_);
    if (growth_ <= kEnoughGrowth) return enter(Phase::Finished);
    begin(calm_ * growth_);
}

/// One pair more whenever the swing changes sides, as long as it is more than the encoder's steps.
void StiffnessSearch::countPeaks(double x) noexcept {
    const double away = std::abs(x);
    if (x == 0.0 || (x > 0.0) == positive_) {
        peak_ = std::max(peak_, away);
        return;
    }
    if (before_ > 0.0 && std::min(before_, peak_) > kPeak * step_) {
        ++pairs_;
        sum_x_ += before_;
        sum_y_ += peak_;
        sum_xx_ += before_ * before_;
        sum_xy_ += before_ * peak_;
    }
    before_ = peak_;
    peak_ = away;
    positive_ = x > 0.0;
}

bool StiffnessSearch::rests() const noexcept {
    if (!(late_ < early_ || late_ <= kRest * step_)) return false;
    if (pairs_ < kFewestPairs) return true;
    // g = spread_xy / spread_xx; peaks that are all alike say nothing of it.
    const double mean = sum_x_ / pairs_;
    const double spread_xx = sum_xx_ / pairs_ - mean * mean;
    const double spread_xy = sum_xy_ / pairs_ - mean * sum_y_ / pairs_;
    return !(spread_xx > kSpread * kSpread * mean * mean && spread_xy > spread_xx);
}

/// False at the first sign of trouble.
bool StiffnessSearch::watch(const Vec3& x, const Vec3& last) noexcept {
    if (!(x.norm() <= params_.max_travel)) return false;
    if (phase_ != Phase::Idle) return true;
    const double away = x.cwiseAbs().maxCoeff();
    countPeaks(x[axis_]);
    if (ticks_ < kStretchTicks) early_ = std::max(early_, away);
    if (ticks_ >= kIdleTicks - kStretchTicks) late_ = std::max(late_, away);
    given_ += force_.dot(x - last);
    return given_ <= kMostGiven * stored_ + params_.max_force * kRest * step_;
}

Wrench StiffnessSearch::step(const DeviceReading& reading) noexcept {
    if (finished()) return {};
    if (!reading.fresh || !isFinite(reading.X_BD)) {
        force_ = Vec3::Zero();
        return {};
    }
    if (phase_ == Phase::Settle) {
        // No spring, the damper alone: whatever swings comes to rest, and the anchor is where that is.
        const Vec3 drift = ticks_ > 0 ? way(reading.X_BD) : Vec3(Vec3::Zero());
        anchor_ = reading.X_BD;
        last_ = Vec3::Zero();
        const Vec3 brake = -params_.damping / kTickSeconds * drift;
        force_ = brake.norm() <= params_.max_force ? brake : Vec3(Vec3::Zero());
        if (++ticks_ >= kSettleTicks) enter(Phase::Press);
        return wrench();
    }
    const Vec3 x = way(reading.X_BD);
    const Vec3 moved = x - last_;
    for (int i = 0; i < 3; ++i)
        if (moved[i] != 0.0) step_ = std::min(step_, std::abs(moved[i]));
    bool calm = watch(x, last_);
    last_ = x;
    Vec3 force = -stiffness_ * x - params_.damping / kTickSeconds * moved;
    if (phase_ == Phase::Press) {
        const double ramp = std::min(1.0, static_cast<double>(ticks_) / kRampTicks);
        force[axis_] += ramp * std::min(kPress * params_.max_force, kPressTravel * params_.max_travel * stiffness_);
        stored_ = 0.5 * stiffness_ * x.squaredNorm();
    }
    // A soft spring overshoots its press and is cut; a demand far beyond the limit is a swing that grows.
    const double demand = force.norm() / params_.max_force;
    calm = calm && demand <= kMostDemand;
    if (demand > 1.0) force *= (1.0 - 0x1p-40) / demand;
    if (!calm) {
        force_ = Vec3::Zero();
        fail();
        return {};
    }
    force_ = force;
    ++ticks_;
    if (phase_ == Phase::Press && ticks_ >= kPressTicks) {
        enter(Phase::Idle);
        early_ = late_ = given_ = 0.0;
        peak_ = std::abs(x[axis_]);
        positive_ = x[axis_] > 0.0;
        before_ = sum_x_ = sum_y_ = sum_xx_ = sum_xy_ = 0.0;
        pairs_ = 0;
    } else if (phase_ == Phase::Idle && ticks_ >= kIdleTicks) {
        if (!rests()) {
            force_ = Vec3::Zero();
            fail();
            return {};
        }
        enter(Phase::Settle);
        if (++axis_ == 3) judge();
    }
    return wrench();
}

Vec3 StiffnessSearch::way(const Pose& X_BD) const noexcept {
    return params_.rotation ? rotationVector(X_BD.q * anchor_.q.conjugate()) : Vec3(X_BD.p - anchor_.p);
}

Wrench StiffnessSearch::wrench() const noexcept {
    return params_.rotation ? Wrench{Vec3::Zero(), force_} : Wrench{force_, Vec3::Zero()};
}

}  // namespace passung::loop
