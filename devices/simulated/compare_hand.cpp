#include "devices/simulated/compare_hand.h"

#include <algorithm>
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
constexpr double kShakeWidth = 12e-3;    // [m] to either side
constexpr double kRestForce = 0.3;       // of the force of pressing
constexpr double kThink = 0.4;           // [s] before the answer, beside the lapse
constexpr double kReturnDuration = 0.9;  // [s] back to the start
constexpr double kTurns = 2.0 * std::numbers::pi;

}  // namespace

CompareHand::CompareHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                         std::uint64_t seed)
    : Arm(params, task, registration, seed),
      goal_(std::get<CompareGoal>(task_.goal)),
      attention_(seed ^ fnv1a64("attention")),
      impression_(goal_.quantity) {}

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
            if (percept.go) start(percept);
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

Vec3 CompareHand::feltPlace(const Percept& percept) const noexcept {
    return task_.X_WTarget.inverse() * percept.X_WFelt.p;
}

void CompareHand::start(const Percept& percept) noexcept {
    p_TP_ = task_.X_WTarget.inverse() * X_WRef_.p;
    touch_ = feltPlace(percept);
    felt_start_ = touch_.z();
    reached_ = false;
    impression_.clear();
    const bool in_the_air = goal_.quantity == Quantity::Force || goal_.quantity == Quantity::Inertia;
    enter(in_the_air ? Phase::Feel : Phase::Down);
}

void CompareHand::down(const Percept& percept) noexcept {
    p_TP_.z() -= pace_ * params_.descend_speed * kTickSeconds;
    X_WRef_.p = task_.X_WTarget * p_TP_;
    if (!reached_ && percept.F_felt.force.norm() >= kNothingFelt) {
        reached_ = true;
        impression_.touch(std::max(0.0, felt_start_ - feltPlace(percept).z()));
    }
    if (!touches(percept)) return;
    touch_ = feltPlace(percept);
    enter(Phase::Feel);
}

/// Where the part shall be at this moment of feeling.
Vec3 CompareHand::intended() const noexcept {
    const double press = params_.press_force / params_.stiffness;
    const double shake = std::sin(kTurns * kShakes * t_);
    Vec3 p = touch_;
    switch (goal_.quantity) {
        case Quantity::Stiffness:
            p.z() -= (0.55 - 0.45 * std::cos(kTurns * kWave * t_)) * press;
            break;
        case Quantity::Roughness:
            p.z() -= kStrokeForce * press;
            p.x() += kStrokeWidth * std::sin(kTurns * kStroke * t_);
            break;
        case Quantity::Viscosity:
            p.z() -= (kStrokeForce + 0.3 * shake) * press;
            break;
        case Quantity::Inertia:
            p.x() += kShakeWidth * shake;
            break;
        case Quantity::Position:
            p.z() -= kRestForce * press;
            break;
        case Quantity::Force:
            break;
    }
    return p;
}

void CompareHand::feel(const Percept& percept) noexcept {
    p_TP_ = intended();
    X_WRef_.p = task_.X_WTarget * p_TP_;
    impression_.learn(feltPlace(percept) - touch_, task_.X_WTarget.q.conjugate() * percept.F_felt.force);
}

void CompareHand::endInterval() noexcept {
    impressions_[intervals_++] = impression_.value() * std::exp(params_.feeling_error * perception_.normal());
    startReach(task_.X_WHeldStart, kReturnDuration / pace_);
    phase_ = intervals_ < impressions_.size() ? Phase::ToStart : Phase::Think;
}

int CompareHand::answer() noexcept {
    const bool attends = attention_.uniform() >= params_.lapse_rate;
    if (!attends || impressions_[0] == impressions_[1]) return attention_.uniform() < 0.5 ? 1 : 2;
    return impressions_[0] > impressions_[1] ? 1 : 2;
}

}  // namespace passung::simulated
