#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "core/tick/hand_model.h"
#include "core/tick/world.h"

namespace passung::tick {

/// What does not change while a trial runs: the world, and the hands in it, which borrow it.
struct TickModel {
    TickModel() = default;
    TickModel(TickModel&&) noexcept = default;
    TickModel& operator=(TickModel&&) noexcept = default;

    World world;
    std::vector<HandModel> hands;  // in the order of the scene
};

/// What the scene fixes. `scene` must outlive the result.
TickModel makeModel(const scene::Scene& scene);

}  // namespace passung::tick
