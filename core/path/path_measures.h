#pragma once

#include <vector>

#include "core/path/free_room.h"

namespace passung::path {

/// What a path from pose to pose is like, origin straight and turn even between them.
struct PathMeasures {
    double length = 0.0;               // of the origin's way [m]
    double turn = 0.0;                 // sum of all turns [rad]
    Nearness least;                    // at the poses looked at
    Pose X_least;                      // where that is
    double proven = 0.0;               // along all of the path; ≤ 0: between the poses nothing is proven by it [m]
    std::size_t looked_at = 0;         // poses
    std::vector<double> at_waypoints;  // clearance [m], up to kFar
};

inline constexpr double kFar = 0.010;       // clearances are told up to this [m]
inline constexpr double kDenseStep = 1e-5;  // between poses looked at no point goes farther, or less than half of what
                                            // the clearance is there [m]

/// By exact distances at dense poses. Between two of them, with bounds l and m, where no point goes farther than s, the
/// true clearance is nowhere less than (l + m - s) / 2: each pose between is within s' of one and s - s' of the other.
PathMeasures measure(const FreeRoom& room, const std::vector<Pose>& path);

/// Waypoints left out where the straight way past them is proven to be free, and no nearer than `least` [m] and 0.95
/// of what comes nearest in what is left out.
std::vector<Pose> shorten(const FreeRoom& room, const std::vector<Pose>& path, double least);

}  // namespace passung::path
