#pragma once

#include <vector>

#include "devices/simulated/arm.h"

namespace passung::simulated {

/// A hand that follows a drawn line: it goes above its first point, down until something is felt, and along the line,
/// pressing with the asked force. It sees the line with an error, one for the whole trial.
class FollowHand final : public Arm {
public:
    /// @pre params.validate() is empty and task.goal is a FollowGoal with at least two points.
    FollowHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
               std::uint64_t seed);

private:
    enum class Phase { ToStart, HoldStart, Approach, Settle, Down, Follow, Done };

    void begin() noexcept override { phase_ = Phase::ToStart; }
    void choose(const Percept& percept) noexcept override;
    void enter(Phase phase) noexcept;
    void follow(const Percept& percept) noexcept;
    Vec3 pointAt(double way) const noexcept;  // believed, in the target's frame

    const FollowGoal& goal_;
    Vec3 error_;           // of seeing, in the target's frame
    double length_ = 0.0;  // of the line [m]
    Phase phase_ = Phase::ToStart;
    double way_ = 0.0;     // along the line [m]
    double height_ = 0.0;  // of the set-point in the target's frame [m]
};

}  // namespace passung::simulated
