#pragma once

#include <functional>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/scene/scene.h"
#include "study/plan/study_plan.h"

namespace passung::run {

/// Poses of the held part in the world, one a millisecond, along which a condition's ticks are measured.
struct HandPath {
    enum class Origin { SimulatedHand, Pressed };
    Origin origin = Origin::SimulatedHand;
    std::vector<Pose> X_WH;

    static constexpr int kMostTicks = 8000;
};

/// The way of a simulated participant's hand in a trial of the condition, with the condition's own contact, from the
/// start pose on until the trial has ended, at most kMostTicks; the same for the same condition. Where the hand hardly
/// touches anything: the held part is pressed two millimetres into the nearest obstacle and slides on it. Errors: the
/// trial is not done with the device; the scene cannot be built. `report` gets the share that is done and may throw.
Result<HandPath> handPath(const plan::Condition& condition, scene::PartCache& parts,
                          const std::function<void(double share)>& report);

}  // namespace passung::run
