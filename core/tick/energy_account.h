#pragma once

#include "core/base/types.h"
#include "core/tick/few_of_many.h"

namespace passung::tick {

/// What a device shows of its part's weight: a force at a point of the handle (weight.h).
struct Hanging {
    Vec3 f_B = Vec3::Zero();  // device base axes [N]
    Vec3 p_D = Vec3::Zero();  // [m]
};

/// What went through the handle: passivity.h.
struct EnergyAccount {
    double taken_in = 0.0;  // by the controller [J]
    bool has_sample = false;
    Pose X_BD;    // at the good sample before
    Twist ahead;  // by how much that is ahead of where the handle is believed to be, as a motion [m], [rad]
    Twist V_BD;   // from the one before that
    Wrench sent;  // sum of what was sent since
    int ticks = 0;
    double weighed = 0.0;  // sum over them of the share of the part's weight in what was sent
    Hanging hanging;       // whose it is
    double lifted = 0.0;   // liftEnergy of where the handle was believed to be then [J]
};

/// The share of one obstacle in it: contact_energy.h.
struct PairAccount {
    double taken_in = 0.0;  // [J]
    double least = 0.0;     // of taken_in so far, ≤ 0
    Wrench sent;            // of EnergyAccount::sent
};

/// Owner: energy account.
struct EnergyAccounts {
    EnergyAccount energy;
    // Of each part of the scene as an obstacle, and of what none pushes: last. Held: to which something was sent since
    // the good sample before
    FewOfMany<PairAccount> pairs{1};
};

/// What one obstacle does to the held part in this tick.
struct ObstaclePush {
    Wrench wrench;          // of it on the held part, as F_H_W
    double pressure = 0.0;  // the sum of its forces' sizes [N]; of what has no obstacle, the part's weight: 0
};

/// Handed on: the method of contact notes them, contact shares adds the rest of the wrench, weight in the hand
/// the weight, the output delay delays them, no wrench clears them.
struct Pushes {
    static constexpr bool kHandedOn = true;
    FewOfMany<ObstaclePush> pushes{1};  // of each obstacle, and of none: last; held: that push
};

}  // namespace passung::tick
