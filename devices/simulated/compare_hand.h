#pragma once

#include <array>

#include "devices/simulated/arm.h"
#include "devices/simulated/impression.h"

namespace passung::simulated {

/// A hand that feels something twice and says in which interval there was more of it (impression.h). For force it keeps
/// the part where it starts, for inertia it shakes it there; else it goes straight down onto the target and, stiffness:
/// presses in slow waves; viscosity: in quicker ones; roughness: strokes under even pressure; position: rests. What an
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
    void start(const Percept& percept) noexcept;
    void down(const Percept& percept) noexcept;
    void feel(const Percept& percept) noexcept;
    Vec3 intended() const noexcept;
    Vec3 feltPlace(const Percept& percept) const noexcept;
    void endInterval() noexcept;
    int answer() noexcept;

    const CompareGoal& goal_;
    Random attention_;  // lapses, and answers by chance
    Phase phase_ = Phase::ToStart;
    std::size_t intervals_ = 0;
    std::array<double, 2> impressions_{};
    Vec3 p_TP_ = Vec3::Zero();   // intended, in the target's frame [m]
    Vec3 touch_ = Vec3::Zero();  // where the target was touched, or what is shaken began
    double felt_start_ = 0.0;    // height at which the interval began
    bool reached_ = false;       // the first force was felt
    Impression impression_;      // of the running interval
};

}  // namespace passung::simulated
