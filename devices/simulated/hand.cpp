// Peg-in-hole by a simulated person. Everything a phase decides comes from a Percept (late, and only what a person
// could know) and from the belief about the bore's place; tests/devices moves the real bore to prove it.
//
// The frame M is the believed mouth: +z out of the bore. Set-points are expressed there as p_MP and turned into a
// handle pose at the end of act(). The arm's spring turns the distance between set-point and handle into force, so
// pressing with a force f means a set-point that leads by f/k; an integrator on the felt force corrects for friction.
#include "devices/simulated/hand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

// Thresholds of judgement; proposed here.
constexpr double kSettleDuration = 0.45;  // [s]
constexpr double kPuzzled = 0.8;          // [s] longer look after a try that failed
constexpr double kLiftDuration = 0.7;     // [s]
constexpr double kLeftBehind = 10e-3;  // [m] the drawn part stays so far behind the hand, nothing felt: seen to be held
constexpr double kClearlyInside = 4e-3;    // [m] seen below the mouth: no wall gives way that far
constexpr double kDrop = 1e-3;             // [m] seen below the pressed level: it goes in
constexpr double kCaughtForce = 0.8;       // [N] sideways: the tip is held by something
constexpr double kStaysBack = 3e-3;        // [m] behind the spiral: a device with much friction is pushed harder
constexpr double kSeenCaught = 2e-3;       // [m] the drawn part stays so far beside the hand, and cues tell of contact
constexpr double kCuedJudgement = 0.5;     // of the usual time, where a cue tells of contact too
constexpr double kCuedCare = 0.5;          // of the usual speed, where cues alone tell of contact
constexpr double kCaughtTime = 0.12;       // [s] for so long
constexpr double kCaughtPause = 0.6;       // [s] of searching before being caught counts (again)
constexpr double kProgress = 0.4e-3;       // [m] seen progress that counts
constexpr double kStallTime = 0.6;         // [s] without it: stuck
constexpr double kBackOffDuration = 0.35;  // [s]
constexpr double kBackOffLift = 1.5e-3;    // [m]
constexpr double kWiggle = 0.6e-3;         // [m]
constexpr double kWiggleTurn = 0.01;       // [rad]
constexpr int kMostStalls = 2;             // pushes without depth before searching on
constexpr int kFutileStalls = 4;           // so many, and less deep than
constexpr double kShallow = 0.6;           // of the asked depth: what is not round is not in
constexpr double kBeside = 3.0;            // standard deviations of seeing next to the hole: doubt
constexpr double kExtraDepth = 1e-3;       // [m] beyond the asked depth, to be sure
constexpr double kBottomShare = 0.88;      // of the asked depth: a stop there is taken for the end
constexpr double kEndGain = 2.5;           // [1/s] slows down before the asked depth
constexpr double kEndSpeed = 2e-3;         // [m/s]
constexpr double kSeenTurned = 0.05;       // [rad] off a quarter of the mouth's: part and mouth look turned
constexpr double kSearchTurn = 0.03;       // [rad] to and fro about the axis, for what has failed and is not round
constexpr double kSearchTurnRate = 0.9;    // [1/s]
constexpr double kTurnRate = 0.6;          // [rad/s] about the axis, slowly
constexpr double kTurnGrowth = 0.15;       // [rad] so much farther from swing to swing
constexpr double kMostTurn = 0.6;          // [rad] to either side; nobody errs by more in what is seen
constexpr double kTurnPitch = 1.0e-3;      // [m] between turns of the spiral, as wide as chamfers catch
constexpr double kTurnSpeed = 0.5e-3;      // [m/s] along it: about half a pitch in a swing
constexpr double kTurnRadius = 1.2e-3;     // [m] of that spiral; then a new look is worth more
constexpr double kHeldBack = 0.2;          // [rad] the part is seen so far behind the turn: it is held by something
constexpr double kGiveWay = 0.25;          // [s] time constant of yielding to the sides and in tilt
constexpr double kSlideGain = 2.0;         // [1/s]; × delay of seeing < 1/2 keeps it stable
constexpr double kSlideSpeed = 5e-3;       // [m/s]

}  // namespace

const char* phaseName(HandPhase phase) noexcept {
    constexpr std::array<const char*, 12> kNames = {"to_start", "hold_start", "approach", "settle",
                                                    "descend",  "press",      "search",   "turn",
                                                    "insert",   "back_off",   "lift",     "hold"};
    return kNames[static_cast<std::size_t>(phase)];
}

Hand::Hand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration, std::uint64_t seed)
    : Arm(params, task, registration, seed), X_WTarget_(task.X_WTarget) {
    look();
}

// ---- senses -----------------------------------------------------------------------------------------------------

void Hand::look() noexcept {
    const Vec3 shift(params_.lateral_error * perception_.normal(), params_.lateral_error * perception_.normal(),
                     params_.depth_error * perception_.normal());
    const Vec3 tilt(params_.tilt_error * perception_.normal(), params_.tilt_error * perception_.normal(), 0.0);
    X_TM_ = {rotationFromVector(tilt), shift};
    believe();
}

void Hand::believe() noexcept {
    X_WM_ = X_WTarget_ * X_TM_;
    if (!turns_) {
        q_goal_ = task_.X_WHeldStart.q;
        return;
    }
    const Vec3 axis = X_WM_.q * Vec3::UnitZ();
    const Quat align = rotationBetween(task_.X_WHeldStart.q * Vec3::UnitZ(), axis);
    q_goal_ = (align * task_.X_WHeldStart.q).normalized();
    if (fitting_turn_ != 0.0) q_goal_ = (rotationFromVector(fitting_turn_ * axis) * q_goal_).normalized();
}

/// By how much part and mouth are seen turned against each other, off the nearest quarter turn [rad].
double Hand::seenTurned() const noexcept {
    const Quat away = X_WTarget_.q.conjugate() * task_.X_WHeldStart.q;
    return std::remainder(2.0 * std::atan2(away.z(), away.w()), 0.5 * std::numbers::pi);
}

bool Hand::looksTurned() const noexcept { return !task_.round && turns_ && std::abs(seenTurned()) > kSeenTurned; }

// What failed as it came is tried as it looks to fit, then as it came again, and so on: first turned to the nearest
// quarter turn of the mouth, after some failures to the others. The eye errs in that as in tilt; touch does the rest,
// see searchTurn().
void Hand::turnToFit() noexcept {
    if (task_.round || !turns_) return;
    if (knows_turn_) {
        ++turns_tried_;
        fitting_turn_ = params_.tilt_error * perception_.normal();
        return;
    }
    constexpr std::array kQuarters{0, 0, 0, 1, -1, 2};
    const auto next = static_cast<std::size_t>(turns_tried_++) % (2 * kQuarters.size());
    const int quarters = kQuarters[next / 2];
    const double off = seenTurned();
    fitting_turn_ = 0.0;
    if (next % 2 == 1 || (quarters == 0 && std::abs(off) < kSeenTurned)) return;
    fitting_turn_ = 0.5 * std::numbers::pi * quarters - off + params_.tilt_error * perception_.normal();
}

/// To and fro about the axis, of what has failed and is not round.
Vec3 Hand::searchTurn(double tau) const noexcept {
    if (turns_tried_ == 0) return Vec3::Zero();
    return kSearchTurn * std::sin(kSearchTurnRate * tau) * (X_WM_.q * Vec3::UnitZ());
}

/// What did not go in and is not round is turned twice for each search without.
bool Hand::searchesByTurning() const noexcept { return !task_.round && turns_ && attempt_ % 3 != 0; }

double Hand::seenDepth(const Percept& percept) const noexcept {
    return percept.sees ? -(X_WM_.inverse() * percept.X_WSeen.p).z() : -1.0;
}

// Where no force is displayed the eyes alone tell of contact. A force lets the part lag behind the hand as well, but is
// felt then.
bool Hand::seenHeld(const Percept& percept) const noexcept {
    return percept.sees && percept.F_felt.force.norm() < kNothingFelt &&
           -seenDepth(percept) - feltPosition(percept).z() > kLeftBehind;
}

// Who is told of contact looks where the part is and where the hand.
bool Hand::seenCaught(const Percept& percept) const noexcept {
    return percept.sees && (seenPosition(percept) - feltPosition(percept)).head<2>().norm() > kSeenCaught;
}

Vec3 Hand::seenPosition(const Percept& percept) const noexcept { return X_WM_.inverse() * percept.X_WSeen.p; }

Vec3 Hand::seenTurn(const Percept& percept) const noexcept {
    return rotationVector(percept.X_WSeen.q * q_goal_.conjugate());
}

Vec3 Hand::feltPosition(const Percept& percept) const noexcept { return X_WM_.inverse() * percept.X_WFelt.p; }

Vec3 Hand::feltForce(const Percept& percept) const noexcept { return X_WM_.q.conjugate() * percept.F_felt.force; }

Vec3 Hand::feltTurn(const Percept& percept) const noexcept {
    return rotationVector(percept.X_WFelt.q * q_goal_.conjugate());
}

/// How far the part, as it is drawn or as the wrist feels it, stays behind the turn that is meant [rad].
double Hand::turnHeldBack(const Percept& percept) const noexcept {
    const Vec3 axis = X_WM_.q * Vec3::UnitZ();
    const Vec3 shown = percept.sees ? seenTurn(percept) : feltTurn(percept);
    return std::abs(twist_ - axis.dot(shown));
}

// ---- building blocks of movement --------------------------------------------------------------------------------

void Hand::enter(HandPhase phase) noexcept {
    phase_ = phase;
    restartClock();
}

void Hand::startReach(HandPhase phase, const Pose& to, double duration) noexcept {
    Arm::startReach(to, duration);
    phase_ = phase;
}

Pose Hand::aboveMouth() const noexcept { return {q_goal_, X_WM_ * Vec3(0.0, 0.0, params_.approach_height)}; }

void Hand::placeReference(const Vec3& p_MP, const Vec3& turn) noexcept {
    X_WRef_ = {(rotationFromVector(turn) * q_goal_).normalized(), X_WM_ * p_MP};
}

void Hand::pressWith(double force, const Percept& percept) noexcept {
    if (goesByCues(percept))
        p_MP_.z() = cuedHeight(p_MP_.z(), percept);
    else if (!seenHeld(percept))
        p_MP_.z() = pressedHeight(p_MP_.z(), force, feltPosition(percept).z(),
                                  pressure(percept, force, feltForce(percept).z()));
}

// ---- phases -----------------------------------------------------------------------------------------------------

void Hand::toStart() noexcept {
    X_WRef_ = reach_.at(t_);
    if (t_ >= reach_.duration) enter(HandPhase::HoldStart);
}

void Hand::holdStart(const Percept& percept) noexcept {
    removeOffset(percept);
    if (percept.go) startReach(HandPhase::Approach, aboveMouth(), params_.approach_duration / pace_);
}

void Hand::approach() noexcept {
    X_WRef_ = reach_.at(t_);
    if (t_ >= reach_.duration) enter(HandPhase::Settle);
}

void Hand::settle(const Percept& percept) noexcept {
    if (t_ > params_.haptic_delay) removeOffset(percept);
    if (t_ < kSettleDuration + (attempt_ > 0 ? kPuzzled / pace_ : lapse_)) return;
    p_MP_ = X_WM_.inverse() * X_WRef_.p;
    turn_.setZero();
    enter(HandPhase::Descend);
}

void Hand::descend(const Percept& percept) noexcept {
    p_MP_.z() -= pace_ * params_.descend_speed * kTickSeconds;
    placeReference(p_MP_, turn_);
    best_depth_ = -1.0;
    stalled_ = 0.0;
    stalls_ = 0;
    if (touches(percept) || seenHeld(percept)) enter(HandPhase::Press);
    if (seenDepth(percept) > kClearlyInside) enter(HandPhase::Insert);
}

void Hand::press(const Percept& percept) noexcept {
    pressWith(params_.press_force, percept);
    placeReference(p_MP_, turn_);
    const double depth = seenDepth(percept);
    if (depth > best_depth_ + kProgress) {
        best_depth_ = depth;
        stalled_ = 0.0;
    } else {
        stalled_ += kTickSeconds;
    }
    if (depth > kClearlyInside) {
        enter(HandPhase::Insert);
    } else if (stalled_ > (percept.cue > 0.0 ? kCuedJudgement : 1.0) * params_.judgement + params_.visual_delay) {
        baseline_ = depth;
        startSearch();
    }
}

void Hand::startSearch() noexcept {
    centre_ = p_MP_;
    spiral_angle_ = 0.0;
    twist_ = 0.0;
    swing_ = searchesByTurning() ? (motor_.uniform() < 0.5 ? -kTurnGrowth : kTurnGrowth) : 0.0;
    resumeSearch();
}

void Hand::resumeSearch() noexcept {
    search_time_ = 0.0;
    caught_ = 0.0;
    enter(swing_ != 0.0 ? HandPhase::Turn : HandPhase::Search);
}

double Hand::spiralRadius(double pitch) const noexcept { return pitch / (2.0 * std::numbers::pi) * spiral_angle_; }

// Archimedean spiral r = pitch · angle / 2π at constant speed: angle' = v / sqrt(r² + (pitch/2π)²). After an
// interruption the tip first comes back to the spiral, no faster than `pursuit` [m/s].
void Hand::followSpiral(double pitch, double speed, double pursuit) noexcept {
    const double r = spiralRadius(pitch);
    spiral_angle_ += kTickSeconds * pace_ * speed / std::hypot(r, pitch / (2.0 * std::numbers::pi));
    const Vec3 spiral = centre_ + Vec3(r * std::cos(spiral_angle_), r * std::sin(spiral_angle_), 0.0);
    Vec3 step = spiral - p_MP_;
    step.z() = 0.0;
    const double most = pursuit * kTickSeconds;
    p_MP_ += step.norm() > most ? Vec3(step * (most / step.norm())) : step;
}

void Hand::search(const Percept& percept) noexcept {
    const double r = spiralRadius(params_.search_pitch);
    pressWith(params_.press_force, percept);
    const double speed = (cued_ ? kCuedCare : 1.0) * params_.search_speed;
    followSpiral(params_.search_pitch, speed, 2.0 * speed);
    search_time_ += kTickSeconds;
    const double tau = 2.0 * std::numbers::pi * search_time_;
    const Vec3 wobble = params_.search_tilt * Vec3(std::sin(1.3 * tau), std::sin(1.7 * tau), 0.0);
    placeReference(p_MP_, turn_ + wobble + searchTurn(tau));
    pushAcross(percept, X_WM_.q * Vec3::UnitZ(), kStaysBack);

    const double depth = seenDepth(percept);
    const bool held = search_time_ > kCaughtPause && (feltForce(percept).head<2>().norm() > kCaughtForce ||
                                                      (cued_ && percept.cue > 0.0 && seenCaught(percept)));
    caught_ = held ? caught_ + kTickSeconds : 0.0;
    const int searches = task_.round || !turns_ ? attempt_ : attempt_ / 3;  // before this one
    const double widest = std::min(params_.first_search_radius * (searches + 1), params_.last_search_radius);
    if (depth > baseline_ + kDrop || caught_ > kCaughtTime) {
        foundIt(depth);
    } else if (r > widest) {
        giveUp();
    }
}

void Hand::foundIt(double depth) noexcept {
    best_depth_ = depth;
    stalled_ = 0.0;
    stalls_ = 0;
    enter(HandPhase::Insert);
}

/// One tick of turning to and fro: at each end back, and farther than before up to kMostTurn.
void Hand::swing() noexcept {
    const double side = swing_ > 0.0 ? 1.0 : -1.0;
    twist_ += side * pace_ * (cued_ ? kCuedCare : 1.0) * kTurnRate * kTickSeconds;
    if (side * twist_ < side * swing_) return;
    swing_ = -side * std::min(std::abs(swing_) + kTurnGrowth, kMostTurn);
}

// A form that fits at few turns only: the tip stays where it is and turns; what fits drops in. The wrist is far stiffer
// against a turn than the arm against the sides: walls put the tip where it belongs, but not the turn. Having turned
// all the way in vain the tip goes on beside, still turning.
void Hand::turn(const Percept& percept) noexcept {
    pressWith(params_.press_force, percept);
    swing();
    search_time_ += kTickSeconds;
    if (std::abs(swing_) >= kMostTurn) followSpiral(kTurnPitch, kTurnSpeed, params_.search_speed);
    turn_ = twist_ * (X_WM_.q * Vec3::UnitZ());
    const double tau = 2.0 * std::numbers::pi * search_time_;
    placeReference(p_MP_, turn_ + params_.search_tilt * Vec3(std::sin(1.3 * tau), std::sin(1.7 * tau), 0.0));

    const double depth = seenDepth(percept);
    const bool held =
        search_time_ > kCaughtPause && depth > baseline_ + 0.5 * kDrop && turnHeldBack(percept) > kHeldBack;
    caught_ = held ? caught_ + kTickSeconds : 0.0;
    if (depth > baseline_ + kDrop || caught_ > kCaughtTime) {
        foundIt(depth);
    } else if (spiralRadius(kTurnPitch) > kTurnRadius) {
        giveUp();
    }
}

void Hand::giveUp() noexcept {
    ++attempt_;
    turnToFit();
    look();
    startReach(HandPhase::Lift, aboveMouth(), kLiftDuration / pace_);
}

void Hand::insert(const Percept& percept) noexcept {
    const double depth = seenDepth(percept);
    // A part that is seen going in next to the hole looks like a mistake. Once; then touch is believed.
    const Vec3 seen = X_WM_.inverse() * percept.X_WSeen.p;
    if (!doubted_ && depth > kClearlyInside && seen.head<2>().norm() > kBeside * params_.lateral_error) {
        doubted_ = true;
        return giveUp();
    }
    const double remaining = task_.insertion_depth + kExtraDepth - depth;
    const bool told = goesByCues(percept) && percept.cue > 0.0;  // a wall that is not felt: go where the part is drawn
    const double care = told ? kCuedCare : 1.0;
    const double speed = care * std::clamp(kEndGain * remaining, kEndSpeed, pace_ * params_.insert_speed);
    const Vec3 felt = feltPosition(percept);
    const Vec3 free = told && percept.sees ? seenPosition(percept) : felt;
    const Vec3 free_turn = told && percept.sees ? seenTurn(percept) : feltTurn(percept);
    const double lowest = felt.z() - params_.insert_force / params_.stiffness;
    if (!seenHeld(percept)) p_MP_.z() = std::max(p_MP_.z() - speed * kTickSeconds, std::min(lowest, p_MP_.z()));
    // Giving way: the intention drifts to where the walls have put the part, which takes the side force away.
    p_MP_.head<2>() += (kTickSeconds / kGiveWay) * (free - p_MP_).head<2>();
    turn_ += (kTickSeconds / kGiveWay) * (free_turn - turn_);
    offset_ -= (kTickSeconds / kGiveWay) * offset_;
    turn_offset_ -= (kTickSeconds / kGiveWay) * turn_offset_;
    placeReference(p_MP_, turn_);

    if (depth > best_depth_ + kProgress) {
        best_depth_ = depth;
        stalled_ = 0.0;
        stalls_ = 0;
    } else {
        stalled_ += kTickSeconds;
    }
    bottomed_ = stalled_ > kStallTime && depth > kBottomShare * task_.insertion_depth;
    if (remaining < 0.0 || bottomed_) {
        p_MP_.z() = felt.z();
        enter(HandPhase::Hold);
    } else if (stalled_ > kStallTime) {
        const double angle = motor_.uniform(0.0, 2.0 * std::numbers::pi);
        wiggle_ = kWiggle * Vec3(std::cos(angle), std::sin(angle), 0.0);
        wiggle_turn_ = kWiggleTurn * Vec3(motor_.normal(), motor_.normal(), 0.0);
        ++stalls_;
        enter(HandPhase::BackOff);
    }
}

void Hand::backOff(const Percept& percept) noexcept {
    p_MP_.z() = std::max(
        p_MP_.z(), std::min(p_MP_.z() + 20.0 * kBackOffLift * kTickSeconds, feltPosition(percept).z() + kBackOffLift));
    placeReference(p_MP_ + wiggle_, turn_ + wiggle_turn_);
    if (t_ < kBackOffDuration) return;
    stalled_ = 0.0;
    // A soft wall gives way under more force; only what is deeper than that is inside.
    const double yields = std::max(baseline_, 0.0) * params_.insert_force / params_.press_force + kDrop;
    const bool shallow = best_depth_ < kShallow * task_.insertion_depth;
    const bool futile = !task_.round && shallow && stalls_ >= kFutileStalls;  // in soft walls, or caught turned
    const bool turned = turns_tried_ == 0 && looksTurned();
    if (!futile && (best_depth_ > std::max(yields, kClearlyInside) || stalls_ < kMostStalls)) {
        enter(HandPhase::Insert);
    } else if (!futile && !turned && (spiral_angle_ > 0.0 || swing_ != 0.0)) {
        twist_ = turn_.dot(X_WM_.q * Vec3::UnitZ());
        resumeSearch();
    } else {
        giveUp();
    }
}

void Hand::lift() noexcept {
    X_WRef_ = reach_.at(t_);
    if (t_ < reach_.duration) return;
    spiral_angle_ = 0.0;
    swing_ = 0.0;
    enter(HandPhase::Settle);
}

void Hand::hold(const Percept& percept) noexcept {
    placeReference(p_MP_, turn_);
    const bool slippedBack = seenDepth(percept) < task_.insertion_depth;
    if (!slippedBack || bottomed_ || t_ < params_.visual_delay + params_.judgement) return;
    best_depth_ = seenDepth(percept);
    stalled_ = 0.0;
    enter(HandPhase::Insert);
}

void Hand::startInserting(const Pose& X_WMouth, double depth, const Quat& q_WP, bool round) noexcept {
    task_.X_WHeldStart.q = q_WP;
    task_.round = round;
    knows_turn_ = true;
    task_.insertion_depth = depth;
    X_WTarget_ = X_WMouth;
    attempt_ = 0;
    spiral_angle_ = 0.0;
    bottomed_ = doubted_ = false;
    turns_tried_ = 0;
    swing_ = twist_ = 0.0;
    fitting_turn_ = round || !turns_ ? 0.0 : params_.tilt_error * perception_.normal();
    look();
    startReach(HandPhase::Approach, aboveMouth(), params_.approach_duration / pace_);
}

bool Hand::isInserted(const Percept& percept) const noexcept {
    return phase_ == HandPhase::Hold && t_ > params_.visual_delay + params_.judgement &&
           (bottomed_ || !(seenDepth(percept) < task_.insertion_depth));
}

void Hand::stopPushing(const Percept& percept) noexcept {
    p_MP_.z() = feltPosition(percept).z();
    placeReference(p_MP_, turn_);
}

void Hand::startSliding(const Pose& X_WMouth, double depth, const Quat& q_WP) noexcept {
    startInserting(X_WMouth, depth, q_WP, true);  // as it is turned
    p_MP_ = X_WM_.inverse() * X_WRef_.p;
    turn_ = rotationVector(X_WRef_.q * q_goal_.conjugate());
    enter(HandPhase::Hold);
}

void Hand::slide(const Percept& percept) noexcept {
    const double speed = kSlideGain * (seenDepth(percept) - task_.insertion_depth);
    if (percept.sees) p_MP_.z() += kTickSeconds * std::clamp(speed, -kSlideSpeed, kSlideSpeed);
    placeReference(p_MP_, turn_);
}

void Hand::choose(const Percept& percept) noexcept {
    if (task_.target_hand && percept.sees) {
        X_WTarget_ = percept.X_WHeld[*task_.target_hand];
        believe();
    }
    switch (phase_) {
        case HandPhase::ToStart:
            return toStart();
        case HandPhase::HoldStart:
            return holdStart(percept);
        case HandPhase::Approach:
            return approach();
        case HandPhase::Settle:
            return settle(percept);
        case HandPhase::Descend:
            return descend(percept);
        case HandPhase::Press:
            return press(percept);
        case HandPhase::Search:
            return search(percept);
        case HandPhase::Turn:
            return turn(percept);
        case HandPhase::Insert:
            return insert(percept);
        case HandPhase::BackOff:
            return backOff(percept);
        case HandPhase::Lift:
            return lift();
        case HandPhase::Hold:
            return hold(percept);
    }
}

}  // namespace passung::simulated
