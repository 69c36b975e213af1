#include "devices/simulated/arm.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

constexpr double kPaceSpread = 0.1;      // of the natural logarithm of a trial's pace
constexpr double kOffsetGain = 2.5;      // [1/s] against friction; × delay < 1/2 keeps it stable
constexpr double kPressGain = 2.5;       // [1/s]
constexpr double kWantedCue = 0.4;       // of a cue's full strength: so hard one presses by it
constexpr double kCueSpeed = 6e-3;       // [m/s] for a whole cue too much; × delay / depth of a full cue < 1.5
constexpr double kMostOffset = 15e-3;    // [m]
constexpr double kMostTurnOffset = 0.1;  // [rad]

std::uint64_t derived(std::uint64_t seed, std::uint64_t purpose) {
    std::uint64_t state = seed ^ (0x9e3779b97f4a7c15u * purpose);
    return splitmix64(state);
}

Vec3 clamped(const Vec3& v, double limit) noexcept { return v.cwiseMax(-limit).cwiseMin(limit); }

}  // namespace

Arm::Arm(const HandParams& params, const VisibleTask& task, const HandRegistration& registration, std::uint64_t seed)
    : params_(params),
      task_(task),
      registration_(registration),
      perception_(derived(seed, 1)),
      motor_(derived(seed, 2)),
      tremor_(params.tremor, params.mass, motor_),
      senses_(params, derived(seed, 4)),
      pace_(params.pace * std::exp(kPaceSpread * std::clamp(motor_.normal(), -2.5, 2.5))),
      lapse_(Random(derived(seed, 3)).uniform() < params.lapse_rate ? params.lapse_duration : 0.0) {
    PASSUNG_ASSERT(params.validate().empty());
}

void Arm::restartClock() noexcept {
    phase_start_ = tick_;
    t_ = 0.0;
}

void Arm::startReach(const Pose& to, double duration) noexcept {
    reach_ = {X_WRef_, to, duration};
    restartClock();
}

void Arm::regrip(const Pose& X_HN) noexcept {
    const Quat q_set = (rotationFromVector(turn_offset_) * X_WRef_.q).normalized();
    const Pose X_WSet = Pose{q_set, X_WRef_.p + offset_} * X_HN;
    registration_.X_DH = registration_.X_DH * X_HN;
    X_WRef_ = X_WRef_ * X_HN;
    offset_ = X_WSet.p - X_WRef_.p;
    senses_.regrip(X_HN);
}

void Arm::removeOffset(const Percept& percept) noexcept {
    offset_ = clamped(offset_ + kOffsetGain * kTickSeconds * (X_WRef_.p - percept.X_WFelt.p), kMostOffset);
    const Vec3 turn = rotationVector(X_WRef_.q * percept.X_WFelt.q.conjugate());
    turn_offset_ = clamped(turn_offset_ + kOffsetGain * kTickSeconds * turn, kMostTurnOffset);
}

void Arm::pushAcross(const Percept& percept, const Vec3& axis, double patience) noexcept {
    Vec3 behind = X_WRef_.p - percept.X_WFelt.p;
    behind -= axis * axis.dot(behind);
    if (behind.norm() > patience) offset_ = clamped(offset_ + kOffsetGain * kTickSeconds * behind, kMostOffset);
}

double Arm::pressedHeight(double z, double force, double felt_z, double felt_force) const noexcept {
    const double missing = force - felt_force;
    const double speed = std::min(kPressGain * missing / params_.stiffness, params_.insert_speed);
    // Never lead by more than twice the force: a wall that vanishes must not be followed by a fall.
    const double lowest = felt_z - 2.0 * force / params_.stiffness;
    return std::max(z - speed * kTickSeconds, std::min(lowest, z));
}

bool Arm::touches(const Percept& percept) noexcept {
    return percept.F_felt.force.norm() > kContactForce || percept.cue > 0.0 || percept.knock;
}

bool Arm::goesByCues(const Percept& percept) noexcept {
    const bool felt = percept.F_felt.force.norm() >= kNothingFelt;
    cued_ = !felt && (cued_ || percept.cue > 0.0);
    return cued_;
}

double Arm::cuedHeight(double z, const Percept& percept) const noexcept {
    return z + kCueSpeed * (percept.cue - kWantedCue) * kTickSeconds;
}

double Arm::pressure(const Percept& percept, double force, double felt_force) const noexcept {
    return percept.cue > 0.0 ? std::max(felt_force, force * percept.cue / kWantedCue) : felt_force;
}

HandCoupling Arm::act(const Pose& X_BD, const Wrench& F_D_B) noexcept {
    const Pose X_WH = registration_.partFromHandle(X_BD);
    const Quat& q_WB = registration_.X_WB.q;
    senses_.feel(X_WH, {q_WB * F_D_B.force, q_WB * F_D_B.torque});
    if (tick_ == 0) {
        X_WRef_ = X_WH;
        startReach(task_.X_WHeldStart, kStartDuration);
        begin();
    }
    t_ = static_cast<double>(tick_ - phase_start_) * kTickSeconds;
    choose(senses_.percept());

    HandCoupling coupling;
    coupling.attached = true;
    coupling.mass = params_.mass;
    coupling.inertia = params_.inertia;
    coupling.stiffness = params_.stiffness;
    coupling.damping = params_.damping;
    coupling.rotational_stiffness = params_.rotational_stiffness;
    coupling.rotational_damping = params_.rotational_damping;
    coupling.X_BSet = registration_.handleFromPart(
        {(rotationFromVector(turn_offset_) * X_WRef_.q).normalized(), X_WRef_.p + offset_});
    coupling.F_D_B.force = tremor_.force(static_cast<double>(tick_) * kTickSeconds);
    ++tick_;
    return coupling;
}

}  // namespace passung::simulated
