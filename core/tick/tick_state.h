#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/tick/hand_balance.h"
#include "core/tick/hand_state.h"
#include "core/tick/pick.h"
#include "core/tick/tick_model.h"

namespace passung::tick {

/// Everything that a tick carries to the next. Sized by makeState; a tick never allocates.
struct TickState {
    std::int64_t tick = 0;                     // so many so far
    std::uint64_t hash = 0xcbf29ce484222325u;  // of all outputs, exact bits
    std::vector<Pose> X_WP;                    // of every part; of one in a hand that of its proxy
    std::vector<HandState> hands;
    std::vector<Hold> holds;         // of each hand
    std::vector<PartState> waiting;  // of each of TickModel::pickable; of one in a hand, what a hand has without a part
    std::vector<std::uint8_t> locked;  // of each part: nobody picks it up any more
    AssemblyState assembly;
    BalanceMemory balance;
};

/// The state before the first tick, with all memory that the ticks will need.
TickState makeState(const TickModel& model);

}  // namespace passung::tick
