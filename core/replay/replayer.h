#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/tick_record.h"
#include "core/scene/scene.h"
#include "core/tick/energy_account.h"
#include "core/tick/scene_sequence.h"

namespace passung::replay {

/// The first place where a replay and its recording differ.
struct Difference {
    std::int64_t tick = 0;
    std::string column;
    double recorded = 0.0, replayed = 0.0;
};

struct ReplayReport {
    std::int64_t ticks = 0;
    std::optional<Difference> first_difference;  // in a recorded output
    std::uint64_t state_hash = 0;                // over the exact outputs of all ticks
    std::vector<tick::PairAccount> pairs;        // energy of each obstacle, and of what none pushed, at the end
};

/// Runs the recorded inputs of one attempt (missed periods included) through the tick again and compares every recorded
/// output bit for bit; durations are measurements of the recorded run and not compared.
/// @pre `records` are the attempt's ticks from tick 0 without gaps (gap: reported as a difference in "tick").
ReplayReport replay(const scene::Scene& scene, std::span<const TickRecord> records);
/// The same for scenes that were rendered one after the other.
ReplayReport replay(std::span<const tick::SceneTurn> turns, std::span<const TickRecord> records);
/// The same for scenes of several hands: the records of each, in the order of the scene. A column of another hand than
/// the first is named with its number, as "hand 2: force_N[0]".
/// @pre `hands` has as many as each scene
ReplayReport replayHands(std::span<const tick::SceneTurn> turns, std::span<const std::vector<TickRecord>> hands);

}  // namespace passung::replay
