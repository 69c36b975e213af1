#pragma once

#include "devices/simulated/arm.h"

namespace passung::simulated {

/// A hand of somebody who sees nothing once the trial has begun: it holds the part where it starts, and gives way to
/// what it feels, slowly, in place and turn. Where nothing pulls it stays.
class LedHand final : public Arm {
public:
    /// @pre params.validate() is empty and task.blind.
    LedHand(const HandParams& params, const VisibleTask& task, const HandRegistration& registration, std::uint64_t seed)
        : Arm(params, task, registration, seed) {}

private:
    void begin() noexcept override {}
    void choose(const Percept& percept) noexcept override;
};

}  // namespace passung::simulated
