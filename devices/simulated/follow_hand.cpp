#include "devices/simulated/follow_hand.h"

#include <algorithm>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

// Habits; proposed here.
constexpr double kSettle = 0.45;  // [s]
constexpr double kSpeed = 0.02;   // [m/s] along the line
constexpr double kBeyond = 2e-3;  // [m] past the end, to be sure

}  // namespace

FollowHand::FollowHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                       std::uint64_t seed)
    : Arm(params, task, registration, seed),
      goal_(std::get<FollowGoal>(task_.goal)),
      error_(params.lateral_error * perception_.normal(), params.lateral_error * perception_.normal(), 0.0) {
    for (std::size_t i = 1; i < goal_.points.size(); ++i) length_ += (goal_.points[i] - goal_.points[i - 1]).norm();
}

void FollowHand::enter(Phase phase) noexcept {
    phase_ = phase;
    restartClock();
}

Vec3 FollowHand::pointAt(double way) const noexcept {
    std::size_t i = 1;
    for (; i + 1 < goal_.points.size(); ++i) {
        const double size = (goal_.points[i] - goal_.points[i - 1]).norm();
        if (way <= size) break;
        way -= size;
    }
    const Vec3 along = goal_.points[i] - goal_.points[i - 1];
    return goal_.points[i - 1] + along * (way / along.norm()) + error_;
}

void FollowHand::choose(const Percept& percept) noexcept {
    const Pose& X_WT = task_.X_WTarget;
    switch (phase_) {
        case Phase::ToStart:
            X_WRef_ = reach_.at(t_);
            if (t_ >= reach_.duration) enter(Phase::HoldStart);
            break;
        case Phase::HoldStart:
            removeOffset(percept);
            if (!percept.go) break;
            startReach({X_WRef_.q, X_WT * Vec3(pointAt(0.0) + params_.approach_height * Vec3::UnitZ())},
                       params_.approach_duration / pace_);
            phase_ = Phase::Approach;
            break;
        case Phase::Approach:
            X_WRef_ = reach_.at(t_);
            if (t_ >= reach_.duration) enter(Phase::Settle);
            break;
        case Phase::Settle:
            if (t_ > params_.haptic_delay) removeOffset(percept);
            if (t_ < kSettle + lapse_) break;
            height_ = (X_WT.inverse() * X_WRef_.p).z();
            enter(Phase::Down);
            break;
        case Phase::Down:
        case Phase::Follow:
        case Phase::Done:
            follow(percept);
            break;
    }
}

void FollowHand::follow(const Percept& percept) noexcept {
    const Pose& X_WT = task_.X_WTarget;
    const Vec3 felt = X_WT.inverse() * percept.X_WFelt.p;
    const Vec3 force = X_WT.q.conjugate() * percept.F_felt.force;
    if (phase_ == Phase::Down) {
        height_ -= pace_ * params_.descend_speed * kTickSeconds;
        if (touches(percept)) enter(Phase::Follow);
    } else {
        height_ = goesByCues(percept)
                      ? cuedHeight(height_, percept)
                      : pressedHeight(height_, goal_.force, felt.z(), pressure(percept, goal_.force, force.z()));
        way_ = std::min(way_ + pace_ * kSpeed * kTickSeconds, length_ + kBeyond);
        if (way_ >= length_ + kBeyond) phase_ = Phase::Done;
    }
    Vec3 p = pointAt(way_);
    p.z() = height_;
    X_WRef_.p = X_WT * p;
    if (phase_ != Phase::Down) pushAcross(percept, X_WT.q * Vec3::UnitZ(), 0.0);
}

}  // namespace passung::simulated
