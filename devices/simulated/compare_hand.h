#pragma once

#include <array>

#include "devices/simulated/arm.h"

namespace passung::simulated {

/// A hand that feels something twice and says in which interval there was more of it. In each interval it goes straight
/// down onto the target; stiffness: it presses in slow waves and takes the slope of felt force over felt way;
/// roughness: it strokes under even pressure and takes the root mean square of the felt force's changes. What an
/// interval felt like is remembered with HandParams::feeling_error; in a share of lapse_rate of the trials, and where
/// both felt the same, the answer is left to chance; an interval in which nothing was touched felt like nothing.
class CompareHand final : public Arm {
public:
    /// @pre params.validate() is empty and task.goal is a CompareGoal.
    CompareHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
                std::uint64_t seed);

private:
    enum class Phase { ToStart, HoldStart, Down, Feel, Think, Answer };

    void begin() noexcept override { phase_ = Phase::ToStart; }
    void choose(const Percept& percept) noexcept override;
    void enter(Phase phase) noexcept;
    void down(const Percept& percept) noexcept;
    void feel(const Percept& percept) noexcept;
    void learn(double depth, const Vec3& force) noexcept;
    void endInterval() noexcept;
    int answer() noexcept;

    const CompareGoal& goal_;
    Random attention_;  // lapses, and answers by chance
    Phase phase_ = Phase::ToStart;
    std::size_t intervals_ = 0;
    std::array<double, 2> impressions_{};
    Vec3 p_TP_ = Vec3::Zero();   // intended, in the target's frame [m]
    Vec3 touch_ = Vec3::Zero();  // where the target was touched
    // of the running interval
    double count_ = 0.0, way_ = 0.0, force_ = 0.0, way_way_ = 0.0, way_force_ = 0.0;
    double changes_ = 0.0, change_square_ = 0.0;
    Vec3 last_force_ = Vec3::Zero();
};

}  // namespace passung::simulated
