#pragma once

#include "devices/simulated/arm.h"

namespace passung::simulated {

/// A hand that holds a part where it starts, against whatever pushes: slowly it gives as much as is felt to be missing.
class HoldHand final : public Arm {
public:
    /// @pre params.validate() is empty and task.goal is a HoldGoal.
    HoldHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration,
             std::uint64_t seed)
        : Arm(params, task, registration, seed) {}

private:
    void begin() noexcept override {}
    void choose(const Percept& percept) noexcept override;
};

}  // namespace passung::simulated
