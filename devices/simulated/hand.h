#pragma once

#include <cstdint>

#include "core/base/types.h"
#include "devices/simulated/arm.h"

namespace passung::simulated {

/// What the hand is doing. The order of a smooth trial is the order here up to Insert, then Hold.
enum class HandPhase {
    ToStart,    // reach for the start pose
    HoldStart,  // stay there until the display says go
    Approach,   // reach to above the bore that is seen
    Settle,     // stop, look, correct what friction held back
    Descend,    // down until something is felt or the part is seen inside
    Press,      // lean on it and look whether it goes in
    Search,     // a growing spiral under light pressure
    Turn,       // to and fro about the axis under light pressure, farther and farther, then along a spiral too
    Insert,     // push along the bore, give way to the sides
    BackOff,    // stuck: pull back a little and wiggle
    Lift,       // nothing found: up and look again
    Hold,       // seen at the asked depth: keep still
};
const char* phaseName(HandPhase phase) noexcept;

/// A simulated person's hand doing peg-in-hole. It knows its posture, the displayed force and the displayed image, each
/// late and the bore's place seen with an error; where parts are touched it must find out.
/// All but the constructor rt-safe; the same seed gives the same movements bit for bit.
class Hand : public Arm {
public:
    /// @pre params.validate() is empty.
    Hand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration, std::uint64_t seed);

    HandPhase phase() const noexcept { return phase_; }

protected:
    void begin() noexcept override { phase_ = HandPhase::ToStart; }
    void choose(const Percept& percept) noexcept override;

    /// From now on choose() puts the held part's origin `depth` [m] deep into the bore whose mouth is seen there, the
    /// part turned as `q_WP` but for the bore's axis. It begins with a reach to above the mouth. Where it is not
    /// `round` the turn about the axis is looked at as well, with an error, and searched for.
    void startInserting(const Pose& X_WMouth, double depth, const Quat& q_WP, bool round) noexcept;
    /// As deep as asked, or on the ground, as far as it is seen.
    bool isInserted(const Percept& percept) const noexcept;
    /// It went no deeper, near the asked depth.
    bool onGround() const noexcept { return bottomed_; }
    /// How often in a row it was pushed and went no deeper.
    int stalls() const noexcept { return stalls_; }
    /// Pushes no more: means the part to be where it is felt.
    void stopPushing(const Percept& percept) noexcept;
    /// As startInserting() with a part that is in the bore already; then slide() in place of choose().
    void startSliding(const Pose& X_WMouth, double depth, const Quat& q_WP) noexcept;
    /// One tick: along the bore, until the part is seen at the asked depth.
    void slide(const Percept& percept) noexcept;

    bool turns_ = true;  // the handle can be turned

private:
    void enter(HandPhase phase) noexcept;
    void startReach(HandPhase phase, const Pose& to, double duration) noexcept;
    void look() noexcept;
    void believe() noexcept;
    double seenTurned() const noexcept;
    bool looksTurned() const noexcept;
    void turnToFit() noexcept;
    Vec3 searchTurn(double tau) const noexcept;
    bool searchesByTurning() const noexcept;
    double seenDepth(const Percept& percept) const noexcept;
    Vec3 seenPosition(const Percept& percept) const noexcept;
    Pose aboveMouth() const noexcept;

    void toStart() noexcept;
    void holdStart(const Percept& percept) noexcept;
    void approach() noexcept;
    void settle(const Percept& percept) noexcept;
    void descend(const Percept& percept) noexcept;
    void press(const Percept& percept) noexcept;
    void search(const Percept& percept) noexcept;
    void turn(const Percept& percept) noexcept;
    void swing() noexcept;
    void insert(const Percept& percept) noexcept;
    void backOff(const Percept& percept) noexcept;
    void lift() noexcept;
    void hold(const Percept& percept) noexcept;

    void pressWith(double force, const Percept& percept) noexcept;
    void startSearch() noexcept;
    void resumeSearch() noexcept;
    void followSpiral(double pitch, double speed, double pursuit) noexcept;
    double spiralRadius(double pitch) const noexcept;
    void foundIt(double depth) noexcept;
    void giveUp() noexcept;
    void placeReference(const Vec3& p_MP, const Vec3& turn) noexcept;
    bool seenHeld(const Percept& percept) const noexcept;
    bool seenCaught(const Percept& percept) const noexcept;
    Vec3 feltPosition(const Percept& percept) const noexcept;
    Vec3 feltForce(const Percept& percept) const noexcept;
    Vec3 feltTurn(const Percept& percept) const noexcept;
    double turnHeldBack(const Percept& percept) const noexcept;
    Vec3 seenTurn(const Percept& percept) const noexcept;

    HandPhase phase_ = HandPhase::ToStart;

    // belief about the mouth M and movement relative to it
    Pose X_WTarget_;  // as drawn
    Pose X_TM_;       // how wrongly it was looked at
    Pose X_WM_;
    Quat q_goal_;                 // the part's orientation along the believed axis
    double fitting_turn_ = 0.0;   // about that axis, on top of the orientation at the start [rad]
    Vec3 p_MP_ = Vec3::Zero();    // intended tip in M [m]
    Vec3 turn_ = Vec3::Zero();    // intended rotation on top of q_goal_, rotation vector in W
    double baseline_ = 0.0;       // seen depth at which pressing got no further [m]
    Vec3 centre_ = Vec3::Zero();  // of the spiral, in M
    int attempt_ = 0;             // searches since go
    int turns_tried_ = 0;         // of them with the part turned to fit
    double spiral_angle_ = 0.0;   // [rad]
    double twist_ = 0.0;          // about the axis, while searching by turning [rad]
    double swing_ = 0.0;          // where to it turns; 0: it does not search by turning [rad]
    double caught_ = 0.0;         // how long something has held the tip sideways [s]
    double search_time_ = 0.0;    // since the spiral was last taken up [s]
    double best_depth_ = 0.0;     // seen so far in this push [m]
    double stalled_ = 0.0;        // time without progress [s]
    int stalls_ = 0;
    Vec3 wiggle_ = Vec3::Zero();
    Vec3 wiggle_turn_ = Vec3::Zero();
    bool bottomed_ = false;
    bool knows_turn_ = false;  // it is known how the part is to be turned, but for what the eye errs
    bool doubted_ = false;     // has once pulled out because it looked wrong
};

}  // namespace passung::simulated
