#include "devices/simulated/assemble_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/tick_record.h"

namespace passung::simulated {
namespace {

// Habits; proposed here.
constexpr double kOver = 15e-3;       // [m] over a grip before going down and after letting go
constexpr double kClear = 10e-3;      // [m] between what is carried and what is seen below
constexpr double kCorridor = 40e-3;   // [m] beside the way: what stands there is carried over
constexpr double kLookTime = 0.3;     // [s] beside the delay of seeing
constexpr double kDownTime = 0.6;     // [s] reach to the grip
constexpr double kSteadyTime = 0.35;  // [s] beside the delay of feeling
constexpr double kGraspTime = 0.5;    // [s] beside the delay of seeing: a part that is not in the hand then was missed
constexpr double kLiftTime = 0.8;     // [s]
constexpr double kSlideTime = 1.2;    // [s]
constexpr double kCorrectTime = 0.5;  // [s] for a corrective reach
constexpr double kCheckTime = 0.7;    // [s] beside the delay of seeing
constexpr int kCorrections = 3;       // corrections before letting go
constexpr int kSlides = 2;            // of a part that is in the bore, before it is taken out
constexpr double kInside = 4e-3;      // [m] below the mouth, and no farther beside it: in the bore
constexpr int kPushes = 2;            // in a row without depth: then each time a new look whether it is in
constexpr double kInserted = 0.88;    // of the depth asked for, as seen: it is in
constexpr double kWristRange = 1.2;   // [rad] of turning what is held, from how it was taken; then it is taken anew
constexpr double kReserve = 5e-3;     // [m] within the end of its reach a hand does not work
constexpr double kMoved = 1e-3;       // [m] less is standing still
constexpr double kOffered = 0.5;      // [s] that a part stands still in another hand, to be taken from it
constexpr double kTurned = 1e-4;      // [rad] the posture has changed: the handle can be turned

/// Of the turns of `q_goal` about its z axis that make no difference the one nearest to `q`.
Quat nearestTurn(const Quat& q, const Quat& q_goal, int folds) noexcept {
    if (folds == 0) return (rotationBetween(q * Vec3::UnitZ(), q_goal * Vec3::UnitZ()) * q).normalized();
    const Quat away = q_goal.conjugate() * q;
    const double fold = 2.0 * std::numbers::pi / folds;
    const double turn = fold * std::round(2.0 * std::atan2(away.z(), away.w()) / fold);
    return (q_goal * rotationFromVector(Vec3(0.0, 0.0, std::remainder(turn, 2.0 * std::numbers::pi)))).normalized();
}

double besideWay(const Vec3& p, const Vec3& from, const Vec3& to) noexcept {
    const Eigen::Vector2d way = (to - from).head<2>(), there = (p - from).head<2>();
    const double share = way.squaredNorm() > 0.0 ? std::clamp(there.dot(way) / way.squaredNorm(), 0.0, 1.0) : 0.0;
    return (there - share * way).norm();
}

}  // namespace

AssembleHand::AssembleHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                           std::uint64_t seed)
    : Hand(params, task, registration, seed),
      goal_(std::get<AssembleGoal>(task_.goal)),
      X_DEmpty_(registration.X_DH),
      q_empty_(task.X_WHeldStart.q),
      q_first_(task.X_WHeldStart.q) {
    for (const Part& part : goal_.parts) where_.push_back(part.X_W);
}

void AssembleHand::enter(Stage stage) noexcept {
    stage_ = stage;
    restartClock();
}

void AssembleHand::reach(Stage stage, const Pose& to, double duration) noexcept {
    Arm::startReach({turns_ ? to.q : X_WRef_.q, to.p}, duration / pace_);
    stage_ = stage;
}

bool AssembleHand::arrived() noexcept {
    X_WRef_ = reach_.at(t_);
    return t_ >= reach_.duration;
}

// ---- what is seen -----------------------------------------------------------------------------------------------

/// Parts are remembered where they were seen last.
void AssembleHand::take(const Percept& percept) noexcept {
    const auto see = [this](std::int32_t part, const Pose& X_WP) {
        if (part < 0 || static_cast<std::size_t>(part) >= where_.size()) return;
        const auto i = static_cast<std::size_t>(part);
        where_[i] = {X_WP.q, X_WP.p + goal_.parts[i].shown_offset};
    };
    see(percept.at_rest.part, percept.at_rest.X_WP);
    for (std::size_t hand = 0; hand < percept.held.size(); ++hand) {
        see(percept.held[hand], percept.X_WHeld[hand]);
        stands_[hand] += kTickSeconds;
        if ((percept.X_WHeld[hand].p - p_held_[hand]).norm() < kMoved) continue;
        p_held_[hand] = percept.X_WHeld[hand].p;
        stands_[hand] = 0.0;
    }
}

bool AssembleHand::mayBeDone(const Step& step, std::size_t number, const Percept& percept) const noexcept {
    if ((percept.steps_done >> number & 1u) != 0 || (step.after & ~percept.steps_done) != 0) return false;
    for (std::size_t hand = 0; hand < percept.held.size(); ++hand) {
        const std::int32_t held = percept.held[hand];
        if (held >= 0 && (held == step.into || (held == step.part && hand != goal_.hand))) return false;
    }
    return inHand(percept) < 0 || inHand(percept) == step.part;
}

bool AssembleHand::reaches(std::size_t hand, const Vec3& p) const noexcept {
    if (hand >= goal_.reaches.size()) return true;
    return (p - goal_.reaches[hand].middle).norm() < goal_.reaches[hand].radius - kReserve;
}

/// The hand that is to do the step does not get to where its part is, and another one does.
bool AssembleHand::needsHelp(const Step& step) const noexcept {
    const auto part = static_cast<std::size_t>(step.part);
    const Vec3 grip = where_[part] * goal_.parts[part].grip;
    if (reaches(step.hand, grip)) return false;
    for (std::size_t hand = 0; hand < goal_.reaches.size(); ++hand)
        if (reaches(hand, grip)) return true;
    return false;
}

/// Another hand holds the part of a step of this one's still, within its reach.
bool AssembleHand::isOffered(const Step& step, const Percept& percept) const noexcept {
    const auto part = static_cast<std::size_t>(step.part);
    if (inHand(percept) >= 0 || !reaches(goal_.hand, where_[part] * goal_.parts[part].grip)) return false;
    for (std::size_t hand = 0; hand < percept.held.size(); ++hand)
        if (hand != goal_.hand && percept.held[hand] == step.part && stands_[hand] > kOffered) return true;
    return false;
}

/// Another hand has what this one holds.
bool AssembleHand::isShared(const Percept& percept) const noexcept {
    for (std::size_t hand = 0; hand < percept.held.size(); ++hand)
        if (hand != goal_.hand && percept.held[hand] >= 0 && percept.held[hand] == inHand(percept)) return true;
    return false;
}

/// Where the part is carried to: above its goal, or between two hands.
Vec3 AssembleHand::destination() const noexcept {
    if (!gives_) return seenMouth().p;
    return 0.5 * (goal_.reaches[goal_.hand].middle + goal_.reaches[step().hand].middle);
}

Pose AssembleHand::seenGoal() const noexcept {
    const Step& s = step();
    Pose X_WGoal = s.into < 0 ? s.X_IGoal : where_[static_cast<std::size_t>(s.into)] * s.X_IGoal;
    X_WGoal.q = turns_ ? nearestTurn(seenPart().q, X_WGoal.q, s.folds) : X_WGoal.q;
    return X_WGoal;
}

Pose AssembleHand::seenMouth() const noexcept {
    const Pose X_WGoal = seenGoal();
    return {X_WGoal.q, X_WGoal * Vec3(0.0, 0.0, step().insertion)};
}

bool AssembleHand::isInBore() const noexcept {
    const Vec3 p_MP = seenMouth().inverse() * seenPart().p;
    return p_MP.z() < -kInside && p_MP.head<2>().norm() < kInside;
}

/// As deep as asked at a new look, whatever was believed of the mouth before.
bool AssembleHand::looksInserted() noexcept {
    const Vec3 p_MP = seenMouth().inverse() * Vec3(seenPart().p + errorOfLooking());
    return p_MP.z() < -kInserted * step().insertion && p_MP.head<2>().norm() < kInside;
}

/// Of the origin of what is carried [m], so that it passes over the goal and over the parts beside the way.
double AssembleHand::clearHeight() const noexcept {
    const Vec3 to = destination();
    double top = gives_ || step().insertion > 0.0 ? to.z() : to.z() - part().below;
    for (std::size_t i = 0; i < where_.size(); ++i) {
        const Vec3 grip = where_[i] * goal_.parts[i].grip;
        if (static_cast<std::int32_t>(i) != step().part && besideWay(grip, X_WRef_.p, to) < kCorridor)
            top = std::max(top, grip.z());
    }
    return std::max(top + part().below, X_WRef_.p.z()) + kClear;
}

Vec3 AssembleHand::errorOfLooking() noexcept {
    const double x = params_.lateral_error * perception_.normal();
    const double y = params_.lateral_error * perception_.normal();
    return {x, y, params_.depth_error * perception_.normal()};
}

// ---- stages -----------------------------------------------------------------------------------------------------

void AssembleHand::toStart(const Percept& percept) noexcept {
    if (t_ == 0.0) q_first_ = percept.X_WFelt.q;
    turned_ = turned_ || rotationVector(percept.X_WFelt.q * q_first_.conjugate()).norm() > kTurned;
    if (!arrived()) return;
    turns_ = turned_;
    enter(Stage::HoldStart);
}

void AssembleHand::chooseStep(const Percept& percept) noexcept {
    if (!touches(percept)) removeOffset(percept);
    for (std::size_t i = 0; i < goal_.steps.size(); ++i) {
        const Step& next = goal_.steps[i];
        const bool mine = next.hand == goal_.hand;
        const bool offered = mine && isOffered(next, percept);
        if (!offered && !mayBeDone(next, i, percept)) continue;
        const auto part = static_cast<std::size_t>(next.part);
        const bool helps = !mine && needsHelp(next) && reaches(goal_.hand, where_[part] * goal_.parts[part].grip);
        if (mine ? !offered && inHand(percept) < 0 && needsHelp(next) : !helps) continue;
        if (i != step_) tries_ = 0;
        step_ = i;
        gives_ = helps;
        if (inHand(percept) >= 0) {
            if (!goal_.on_press) buttons_ = goal_.close;  // what was in the hand from the start can be let go as well
            return setOut();
        }
        return reach(Stage::Over, {q_empty_, seenGrip() + kOver * Vec3::UnitZ()}, params_.approach_duration);
    }
}

void AssembleHand::look(const Percept& percept) noexcept {
    if (t_ > params_.haptic_delay) removeOffset(percept);
    if (t_ < params_.visual_delay + kLookTime / pace_ + (rested_ ? 0.0 : lapse_)) return;
    rested_ = true;
    reach(Stage::Down, {X_WRef_.q, seenGrip() + errorOfLooking()}, kDownTime);
}

void AssembleHand::close(const Percept& percept) noexcept {
    buttons_ = goal_.on_press && t_ > kPressDuration ? 0 : goal_.close;
    if (inHand(percept) == step().part) return enter(Stage::Weigh);
    if (t_ < params_.visual_delay + kGraspTime) return;
    if (inHand(percept) >= 0) return enter(Stage::Open);  // another part
    buttons_ = 0;
    reach(Stage::Leave, {X_WRef_.q, X_WRef_.p + kOver * Vec3::UnitZ()}, kDownTime);
}

void AssembleHand::weigh(const Percept& percept) noexcept {
    if (t_ > kPressDuration && goal_.on_press) buttons_ = 0;
    if (isShared(percept)) return restartClock();
    if (t_ < params_.visual_delay + kLookTime / pace_) return;
    X_DP_ = percept.X_WFelt.inverse() * percept.X_WSeen;
    X_DP_.q.normalize();
    regrip(X_DP_);
    if (turns_ && !gives_ && !isInBore() && wristTurn().norm() > kWristRange) return turnOnTheWay();
    setOut();
}

/// By how much the wrist would be turned at the goal against how it takes parts, a rotation vector in W.
Vec3 AssembleHand::wristTurn() const noexcept {
    return rotationVector(seenGoal().q * X_DP_.q.conjugate() * q_empty_.conjugate());
}

/// What the wrist cannot turn in one go is turned as far as it can, put down where it was and taken anew.
void AssembleHand::turnOnTheWay() noexcept {
    takes_anew_ = true;
    p_taken_ = X_WRef_.p;
    const Vec3 way = wristTurn();
    const Quat q_there = rotationFromVector(way * (kWristRange / way.norm())) * q_empty_ * X_DP_.q;
    reach(Stage::TurnUp, {q_there.normalized(), X_WRef_.p + kOver * Vec3::UnitZ()}, kLiftTime);
}

/// With the part in the hand.
void AssembleHand::setOut() noexcept {
    if (step().insertion > 0.0 && isInBore() && tries_ % (kSlides + 1) != 0) {
        startSliding(seenMouth(), step().insertion, seenGoal().q);
        return enter(Stage::Slide);
    }
    reach(Stage::Lift, {X_WRef_.q, Vec3(X_WRef_.p.x(), X_WRef_.p.y(), clearHeight())}, kLiftTime);
}

void AssembleHand::carry() noexcept {
    const Vec3 to = destination();
    if (gives_) return reach(Stage::Carry, {X_WRef_.q, Vec3(to.x(), to.y(), X_WRef_.p.z())}, params_.approach_duration);
    const Pose X_WMouth = seenMouth();
    reach(Stage::Carry, {X_WMouth.q, Vec3(X_WMouth.p.x(), X_WMouth.p.y(), X_WRef_.p.z())}, params_.approach_duration);
}

void AssembleHand::bring() noexcept {
    looks_ = 0;
    if (gives_) return enter(Stage::Give);
    if (!(step().insertion > 0.0)) return reach(Stage::PutDown, seenGoal(), params_.approach_duration);
    startInserting(seenMouth(), step().insertion, turns_ ? seenGoal().q : X_WRef_.q, step().folds == 0);
    stage_ = Stage::Insert;
}

void AssembleHand::give(const Percept& percept) noexcept {
    if (!touches(percept)) removeOffset(percept);
    if (!isShared(percept)) return restartClock();
    if (t_ > kLookTime) enter(Stage::Open);
}

void AssembleHand::insert(const Percept& percept) noexcept {
    Hand::choose(percept);
    if (isInserted(percept)) return enter(onGround() ? Stage::Open : Stage::Slide);
    if (stalls() < kPushes) looks_ = 0;
    if (stalls() < kPushes + looks_) return;
    ++looks_;
    if (!looksInserted()) return;
    stopPushing(percept);
    enter(Stage::Open);
}

void AssembleHand::correct(const Percept& percept) noexcept {
    if (!touches(percept)) removeOffset(percept);
    if (t_ < params_.visual_delay + kLookTime / pace_) return;
    if (++looks_ > kCorrections) return enter(Stage::Open);
    const Pose X_WGoal = seenGoal();
    const double tilt_x = params_.tilt_error * perception_.normal();
    const double tilt_y = params_.tilt_error * perception_.normal();
    const Vec3 tilt(tilt_x, tilt_y, step().folds == 0 ? 0.0 : params_.tilt_error * perception_.normal());
    const Vec3 turn = tilt + rotationVector(X_WGoal.q * percept.X_WSeen.q.conjugate());
    const Vec3 missing = X_WGoal.p - percept.X_WSeen.p + errorOfLooking();
    reach(Stage::PutDown, {(rotationFromVector(turn) * X_WRef_.q).normalized(), X_WRef_.p + missing}, kCorrectTime);
}

void AssembleHand::open(const Percept& percept) noexcept {
    buttons_ = goal_.on_press && t_ <= kPressDuration ? goal_.close : 0;
    if (inHand(percept) < 0 && t_ > kPressDuration) {
        regrip(X_DP_.inverse());
        registration_.X_DH = X_DEmpty_;
        X_DP_ = {};
        return enter(Stage::Check);
    }
    if (t_ > params_.visual_delay + kGraspTime + kPressDuration) restartClock();
}

void AssembleHand::check(const Percept& percept) noexcept {
    const bool done = (percept.steps_done >> step_ & 1u) != 0;
    if (!done && t_ < params_.visual_delay + kCheckTime) return;
    if (!takes_anew_ && !gives_) tries_ = done ? 0 : tries_ + 1;
    takes_anew_ = false;
    reach(Stage::Leave, {q_empty_, X_WRef_.p + kOver * Vec3::UnitZ()}, kDownTime);
}

void AssembleHand::choose(const Percept& late) noexcept {
    Percept percept = late;
    take(percept);
    if (inHand(percept) >= 0) percept.X_WSeen = where_[static_cast<std::size_t>(inHand(percept))];
    const bool carries = stage_ >= Stage::TurnUp && stage_ <= Stage::Correct;
    if (carries && inHand(percept) != step().part) enter(Stage::Open);  // somebody took it
    switch (stage_) {
        case Stage::ToStart:
            return toStart(percept);
        case Stage::HoldStart:
            removeOffset(percept);
            return percept.go ? enter(Stage::Choose) : void();
        case Stage::Choose:
            return chooseStep(percept);
        case Stage::Over:
            return arrived() ? enter(Stage::Look) : void();
        case Stage::Look:
            return look(percept);
        case Stage::Down:
            return arrived() ? enter(Stage::Steady) : void();
        case Stage::Steady:
            removeOffset(percept);
            return t_ > params_.haptic_delay + kSteadyTime / pace_ ? enter(Stage::Close) : void();
        case Stage::Close:
            return close(percept);
        case Stage::Weigh:
            return weigh(percept);
        case Stage::TurnUp:
            return arrived() ? reach(Stage::LayDown, {X_WRef_.q, p_taken_}, kDownTime) : void();
        case Stage::LayDown:
            return arrived() ? enter(Stage::Open) : void();
        case Stage::Lift:
            return arrived() ? carry() : void();
        case Stage::Carry:
            return arrived() ? bring() : void();
        case Stage::Give:
            return give(percept);
        case Stage::Insert:
            return insert(percept);
        case Stage::Slide:
            slide(percept);
            return t_ > kSlideTime ? enter(Stage::Open) : void();
        case Stage::PutDown:
            return arrived() ? enter(Stage::Correct) : void();
        case Stage::Correct:
            return correct(percept);
        case Stage::Open:
            return open(percept);
        case Stage::Check:
            return check(percept);
        case Stage::Leave:
            return arrived() ? enter(Stage::Choose) : void();
    }
}

}  // namespace passung::simulated
