#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "core/tick/hand_model.h"
#include "core/tick/world.h"

namespace passung::tick {

/// What does not change while a trial runs: the world, and the hands in it, which borrow it. A hand that picks parts up
/// has a model for each of them.
struct TickModel {
    TickModel() = default;
    TickModel(TickModel&&) noexcept = default;
    TickModel& operator=(TickModel&&) noexcept = default;

    World world;
    std::vector<HandModel> hands;  // in the order of the scene, as a trial begins
    // Where parts can be picked up (pick.h): which, ascending; each hand with each of them, then with nothing; and each
    // hand with each of them while another one holds it too
    std::vector<std::size_t> pickable;
    std::vector<std::vector<HandModel>> carrying, following;
    scene::Pick pick;
    std::vector<std::size_t> step_order;  // of the assembly: each after those that it is after

    bool picks() const noexcept { return !pickable.empty(); }
    bool canPick(std::size_t hand) const noexcept { return picks() && !carrying[hand].empty(); }
    /// Where `body` is among those that can be picked up.
    std::size_t placeOf(std::size_t body) const noexcept;
    /// Two hands can hold one part.
    bool shares(std::size_t hand) const noexcept { return canPick(hand) && !following[hand].empty(); }
    /// A hand with what it holds. @pre it can hold that
    const HandModel& hand(std::size_t hand, std::size_t body, bool follows = false) const noexcept;
};

struct TickFrame;

/// What looks at fields or surfaces may take in a tick, of all hands together, and what they took in this one [units of
/// proxy.h and surface_follow.h]. What is left of them goes on in the next tick. rt-safe.
std::uint32_t mostWork(const HandModel& model) noexcept;
std::uint32_t workDone(const HandModel& model, const TickFrame& frame) noexcept;

/// What the scene fixes. `scene` must outlive the result.
TickModel makeModel(const scene::Scene& scene);

}  // namespace passung::tick
