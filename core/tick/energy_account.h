#pragma once

#include "core/base/types.h"

namespace passung::tick {

/// What went through the handle: passivity.h.
struct EnergyAccount {
    double taken_in = 0.0;  // by the controller [J]
    bool has_sample = false;
    Pose X_BD;    // at the good sample before
    Twist ahead;  // by how much that is ahead of where the handle is believed to be, as a motion [m], [rad]
    Twist V_BD;   // from the one before that
    Wrench sent;  // sum of what was sent since
    int ticks = 0;
};

/// The share of one pair, an obstacle and the held part, in it: contact_energy.h.
struct PairAccount {
    double taken_in = 0.0;  // [J]
    double least = 0.0;     // of taken_in so far, ≤ 0
    Wrench push;            // of the obstacle on the held part in this tick, as F_H_W
    double pressure = 0.0;  // the sum of its forces' sizes [N]; of what has no obstacle: 0
    Wrench last_sent;       // the pair's share of TickState::last_sent
    Wrench sent;            // of EnergyAccount::sent
};

}  // namespace passung::tick
