#include "devices/simulated/compare_hand.h"

#include <cmath>
#include <numbers>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

// Habits; proposed here.
constexpr double kWave = 0.9;            // [Hz] of pressing
constexpr double kStroke = 0.5;          // [Hz]
constexpr double kStrokeWidth = 6e-3;    // [m] to either side
constexpr double kStrokeForce = 0.7;     // of the force of pressing
constexpr double kFeltForce = 0.5;       // [N] from which on a contact is judged
constexpr double kThink = 0.4;           // [s] before the answer, beside the lapse
constexpr double kReturnDuration = 0.9;  // [s] back to the start
constexpr double kTurns = 2.0 * std::numbers::pi;

}  // namespace

CompareHand::CompareHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                         std::uint64_t seed)
    : Arm(params, task, registration, seed),
      goal_(std::get<CompareGoal>(task_.goal)),
      attention_(seed ^ fnv1a64("attention")) {}

void CompareHand::enter(Phase phase) noexcept {
    phase_ = phase;
    restartClock();
}

void CompareHand::choose(const Percept& percept) noexcept {
    switch (phase_) {
        case Phase::ToStart:
            X_WRef_ = reach_.at(t_);
            if (t_ >= reach_.duration) enter(Phase::HoldStart);
            break;
        case Phase::HoldStart:
            removeOffset(percept);
            if (!percept.go) break;
            p_TP_ = task_.X_WTarget.inverse() * X_WRef_.p;
            count_ = way_ = force_ = way_way_ = way_force_ = changes_ = change_square_ = 0.0;
            enter(Phase::Down);
            break;
        case Phase::Down:
            down(percept);
            break;
        case Phase::Feel:
            feel(percept);
            break;
        case Phase::Think:
            X_WRef_ = reach_.at(t_);
            if (t_ < kThink / pace_ + lapse_) break;
            buttons_ = 1u << (answer() - 1);
            enter(Phase::Answer);
            break;
        case Phase::Answer:
            if (t_ >= kPressDuration) buttons_ = 0;
            break;
    }
    const bool feels = phase_ == Phase::Down || phase_ == Phase::Feel;
    if (feels && t_ > 0.0 && !percept.go) endInterval();
}

void CompareHand::down(const Percept& percept) noexcept {
    p_TP_.z() -= pace_ * params_.descend_speed * kTickSeconds;
    X_WRef_.p = task_.X_WTarget * p_TP_;
    if (!touches(percept)) return;
    touch_ = task_.X_WTarget.inverse() * percept.X_WFelt.p;
    enter(Phase::Feel);
}

void CompareHand::feel(const Percept& percept) noexcept {
    const double wave = goal_.roughness ? kStrokeForce : 0.55 - 0.45 * std::cos(kTurns * kWave * t_);
    p_TP_ = touch_;
    p_TP_.z() -= wave * params_.press_force / params_.stiffness;
    if (goal_.roughness) p_TP_.x() += kStrokeWidth * std::sin(kTurns * kStroke * t_);
    X_WRef_.p = task_.X_WTarget * p_TP_;
    const double height = (task_.X_WTarget.inverse() * percept.X_WFelt.p).z();
    learn(touch_.z() - height, task_.X_WTarget.q.conjugate() * percept.F_felt.force);
}

void CompareHand::learn(double depth, const Vec3& force) noexcept {
    if (force.z() < kFeltForce) return;
    count_ += 1.0;
    way_ += depth;
    force_ += force.z();
    way_way_ += depth * depth;
    way_force_ += depth * force.z();
    if (count_ > 1.0) {
        changes_ += 1.0;
        change_square_ += (force - last_force_).squaredNorm();
    }
    last_force_ = force;
}

void CompareHand::endInterval() noexcept {
    double felt = 0.0;
    if (goal_.roughness) {
        felt = changes_ > 0.0 ? std::sqrt(change_square_ / changes_) : 0.0;
    } else {
        const double spread = count_ * way_way_ - way_ * way_;
        felt = spread > 0.0 ? std::max(0.0, (count_ * way_force_ - way_ * force_) / spread) : 0.0;
    }
    impressions_[intervals_++] = felt * std::exp(params_.feeling_error * perception_.normal());
    startReach(task_.X_WHeldStart, kReturnDuration / pace_);
    phase_ = intervals_ < impressions_.size() ? Phase::ToStart : Phase::Think;
}

int CompareHand::answer() noexcept {
    const bool attends = attention_.uniform() >= params_.lapse_rate;
    if (!attends || impressions_[0] == impressions_[1]) return attention_.uniform() < 0.5 ? 1 : 2;
    return impressions_[0] > impressions_[1] ? 1 : 2;
}

}  // namespace passung::simulated
