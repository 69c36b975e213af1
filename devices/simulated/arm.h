#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "devices/simulated/hand_senses.h"
#include "devices/simulated/minimum_jerk.h"
#include "devices/simulated/task_hand.h"
#include "devices/simulated/tremor.h"

namespace passung::simulated {

inline constexpr double kPressDuration = 0.15;  // [s] that a button is down; proposed here

/// What every hand has: senses, arm and tremor, an intended pose and the means to bring the held part there. Who
/// derives from it decides in choose() what is intended.
class Arm : public TaskHand {
public:
    /// @pre params.validate() is empty.
    Arm(const HandParams& params, const VisibleTask& task, const HandRegistration& registration, std::uint64_t seed);

    void see(const loop::DisplayedImage& image) noexcept override { senses_.see(image); }
    void notice(const GivenCues& cues) noexcept override { senses_.notice(cues); }
    HandCoupling act(const Pose& X_BD, const Wrench& F_D_B) noexcept override;
    std::uint32_t buttons() const noexcept override { return buttons_; }

protected:
    static constexpr double kStartDuration = 0.9;  // [s] reach for the start pose
    static constexpr double kContactForce = 0.7;   // [N] a touch is noticed
    static constexpr double kNothingFelt = 0.2;    // [N] less is no force to speak of

    /// The first reach, to the start pose, is under way.
    virtual void begin() noexcept = 0;
    /// One tick: sets X_WRef_.
    virtual void choose(const Percept& percept) noexcept = 0;

    /// What is done from now on has begun now.
    void restartClock() noexcept;
    void startReach(const Pose& to, double duration) noexcept;
    /// The held part is from now on what is at `X_HN` in the old one's frame; the arm's set-point stays.
    void regrip(const Pose& X_HN) noexcept;
    /// In free space the arm sees that friction keeps it short of where it wants to be, and asks for a little more.
    void removeOffset(const Percept& percept) noexcept;
    /// Likewise while something is touched: only across `axis` (a unit vector), and only if the part stays back by more
    /// than `patience` [m].
    void pushAcross(const Percept& percept, const Vec3& axis, double patience) noexcept;
    /// Height of the set-point over a surface for the next tick, so that `force` comes to be felt on it; `felt_z`,
    /// `felt_force`: height of the held part and force along the same axis.
    double pressedHeight(double z, double force, double felt_z, double felt_force) const noexcept;

    /// Contact is felt, or told by a cue.
    static bool touches(const Percept& percept) noexcept;
    /// Cues alone tell of contact: no force to speak of is felt. Once they have, they are what is gone by.
    bool goesByCues(const Percept& percept) noexcept;
    /// As pressedHeight() where cues stand in for the force: slowly, until they are at kWantedCue.
    double cuedHeight(double z, const Percept& percept) const noexcept;
    /// `felt_force` when nobody wants to press harder than cues say they do: at kWantedCue that is `force`.
    double pressure(const Percept& percept, double force, double felt_force) const noexcept;

    HandParams params_;
    VisibleTask task_;
    HandRegistration registration_;
    Random perception_;  // errors of looking
    Random motor_;       // choices of movement
    Tremor tremor_;
    HandSenses senses_;

    double pace_;   // of this trial against the habit
    double lapse_;  // pause of this trial [s]

    std::int64_t tick_ = 0;
    std::int64_t phase_start_ = 0;
    double t_ = 0.0;  // in the phase [s]

    // intention: where the part shall be
    Reach reach_;
    Pose X_WRef_;
    Vec3 offset_ = Vec3::Zero();  // added to it against friction, world axes [m]
    Vec3 turn_offset_ = Vec3::Zero();
    std::uint32_t buttons_ = 0;
    bool cued_ = false;  // a cue has told of contact that was not felt
};

}  // namespace passung::simulated
