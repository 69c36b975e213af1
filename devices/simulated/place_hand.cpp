#include "devices/simulated/place_hand.h"

namespace passung::simulated {
namespace {

// Habits; proposed here.
constexpr double kLook = 0.4;        // [s] beside the delay of seeing
constexpr double kCorrection = 0.5;  // [s] for a corrective reach
constexpr int kLooks = 3;

}  // namespace

PlaceHand::PlaceHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                     std::uint64_t seed)
    : Arm(params, task, registration, seed), goal_(std::get<PlaceGoal>(task_.goal)) {}

void PlaceHand::enter(Phase phase) noexcept {
    phase_ = phase;
    restartClock();
}

void PlaceHand::choose(const Percept& percept) noexcept {
    switch (phase_) {
        case Phase::ToStart:
            X_WRef_ = reach_.at(t_);
            if (t_ >= reach_.duration) enter(Phase::HoldStart);
            break;
        case Phase::HoldStart: {
            removeOffset(percept);
            if (!percept.go) break;
            Pose X_WTo = goal_.X_WGoal;
            // A round part need not be turned about its axis.
            if (goal_.round)
                X_WTo.q =
                    (rotationBetween(X_WRef_.q * Vec3::UnitZ(), X_WTo.q * Vec3::UnitZ()) * X_WRef_.q).normalized();
            startReach(X_WTo, params_.approach_duration / pace_);
            phase_ = Phase::Reach;
            break;
        }
        case Phase::Reach:
            X_WRef_ = reach_.at(t_);
            // Something is in the way, and only a cue says so: stop, go where the part is drawn, look again.
            if (goesByCues(percept) && percept.cue > 0.0 && percept.sees)
                X_WRef_.p += percept.X_WSeen.p - percept.X_WFelt.p;
            if (t_ >= reach_.duration || (cued_ && percept.cue > 0.0)) enter(Phase::Look);
            break;
        case Phase::Look:
            removeOffset(percept);
            if (t_ >= params_.visual_delay + kLook / pace_ + (looks_ == 0 ? lapse_ : 0.0)) correct(percept);
            break;
        case Phase::Confirm:
            if (t_ >= kPressDuration) buttons_ = 0;
            break;
    }
}

void PlaceHand::correct(const Percept& percept) noexcept {
    if (++looks_ > kLooks) {
        buttons_ = 1;
        return enter(Phase::Confirm);
    }
    if (!percept.sees) return enter(Phase::Look);
    const Vec3 error(params_.lateral_error * perception_.normal(), params_.lateral_error * perception_.normal(),
                     params_.depth_error * perception_.normal());
    const Vec3 tilt(params_.tilt_error * perception_.normal(), params_.tilt_error * perception_.normal(), 0.0);
    const Vec3 missing = goal_.X_WGoal.p - percept.X_WSeen.p + error;
    Vec3 turn = rotationVector(goal_.X_WGoal.q * percept.X_WSeen.q.conjugate());
    if (goal_.round)
        turn = rotationVector(rotationBetween(percept.X_WSeen.q * Vec3::UnitZ(), goal_.X_WGoal.q * Vec3::UnitZ()));
    startReach({(rotationFromVector(turn + tilt) * X_WRef_.q).normalized(), X_WRef_.p + missing}, kCorrection / pace_);
    phase_ = Phase::Reach;
}

}  // namespace passung::simulated
