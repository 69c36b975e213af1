#pragma once

#include "devices/simulated/arm.h"

namespace passung::simulated {

/// A hand that puts the held part to a drawn pose: it reaches there, looks how far it is off, each look with an error
/// of its own, corrects what it saw, and after some looks presses the first button.
class PlaceHand final : public Arm {
public:
    /// @pre params.validate() is empty and task.goal is a PlaceGoal.
    PlaceHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
              std::uint64_t seed);

private:
    enum class Phase { ToStart, HoldStart, Reach, Look, Confirm };

    void begin() noexcept override { phase_ = Phase::ToStart; }
    void choose(const Percept& percept) noexcept override;
    void enter(Phase phase) noexcept;
    void correct(const Percept& percept) noexcept;

    const PlaceGoal& goal_;
    Phase phase_ = Phase::ToStart;
    int looks_ = 0;
};

}  // namespace passung::simulated
