#pragma once

#include <optional>

#include "analysis/truth/separation.h"

namespace passung::truth {

/// The motion nearest to `pull` that obeys all `rows`; nothing if there is none.
///   min ½|u - w|²  s.t.  A u ≥ -g,  by the dual of Lawson and Hanson (1974), chapter 23: least distance programming as
///   non-negative least squares. Written apart from core/motion, for it is to judge what that finds.
std::optional<Eigen::Matrix<double, 6, 1>> leastMotion(const std::vector<FreedomRow>& rows,
                                                       const Eigen::Matrix<double, 6, 1>& pull);

/// (Δx, ρ Δφ) from a pose to another [m].
Eigen::Matrix<double, 6, 1> pullTo(const Pose& from, const Pose& to, double rho);

/// A pose that no motion from it betters, found from a free one on.
struct LeastEnergy {
    Pose X;
    double energy = 0.0;   // ½|w|² of the way that is left to the hand, (Δx, ρ Δφ): over K [m²]
    double overlap = 0.0;  // there [m]
    double way = 0.0;      // from the start, |(Δx, ρ Δφ)| [m]
    int steps = 0;
};

/// Goes downhill from `X_from`: each step is the motion nearest to the hand under the rows of where it is, and under
/// those of where it was nearby, which end the to and fro between contacts of which a pose has but one at a time (a
/// face on a face). Where obstacles are convex a row keeps more than it must, so that a step never passes what it does
/// not know; where they are hollow the rows beside it do. Nothing: not the pair's case, or no end of it was found.
std::optional<LeastEnergy> leastEnergyFrom(const Separation& separation, double rho, const Pose& X_from,
                                           const Pose& X_WH);

}  // namespace passung::truth
