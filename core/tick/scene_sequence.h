#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/tick/step.h"

namespace passung::tick {

inline constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();

/// One of the scenes that are rendered one after the other in one attempt.
struct SceneTurn {
    const TickModel* model = nullptr;  // outlives the sequence
    std::int64_t periods = kForever;   // haptic periods from its first engaged tick until the next scene's turn, > 0
};

/// Scenes in turn, ticks counted through. Each begins as a trial does, with its start gate closed and no wrench; when
/// it has been engaged for its periods the next one takes over; the last one stays. Which scene a tick belongs to
/// follows from the readings and outputs alone, so that a replay finds it again. Only the tick's number and the hash
/// over all outputs go on from scene to scene; the energy account starts anew.
class SceneSequence {
public:
    /// Allocates all that the ticks need. @pre `turns` is not empty
    explicit SceneSequence(std::span<const SceneTurn> turns);

    /// One tick. rt-safe.
    TickOutput step(const DeviceReading& reading) noexcept;

    /// Number of the next tick.
    std::int64_t tick() const noexcept { return states_[current_].tick; }
    std::uint64_t hash() const noexcept { return states_[current_].hash; }
    /// Of each scene in turn: energy of its obstacles in the order of the scene, and of what none pushed.
    std::vector<PairAccount> pairs() const;

private:
    std::vector<SceneTurn> turns_;
    std::vector<TickState> states_;  // one per turn
    std::size_t current_ = 0;
    bool engaged_ = false;       // in the current turn
    std::int64_t rendered_ = 0;  // periods since it engaged
};

}  // namespace passung::tick
