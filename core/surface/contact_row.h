#pragma once

#include <cstdint>

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// A plane that the hand's way pressed two faces against, as a linear condition of the held part's motion, all of it
/// in the frame of the obstacle's body; X is the held part's pose there:
///   n · (X p_held - p_obstacle) ≥ gap.
struct ContactRow {
    std::uint32_t body = 0;                // whose the obstacle's face is
    std::uint32_t held = 0, obstacle = 0;  // faces: clusters of the two trees
    bool on_held = false;                  // the plane turns with the held part
    bool fixed = true;                     // its points are features; else they are found again at each pose
    Vec3 n = Vec3::Zero();                 // unit, body frame, at the pose of now
    Vec3 n_held = Vec3::Zero();            // the same in the part frame
    Vec3 p_held = Vec3::Zero();            // part frame [m]
    Vec3 p_obstacle = Vec3::Zero();        // body frame [m]
    double s = 0.0;                        // n · (X p_held - p_obstacle) at the pose of now [m]
    double bend = 0.0;                     // ≤ 0: what the rows' linear motion overlooks [m]
    double push = 0.0;                     // of the last motion [m]: times the coupling's stiffness, its force
    int idle = 0;                          // ticks since it held
    CornerSeed seed = {};                  // where its points were found

    /// Where it acts, body frame.
    Vec3 point(const Placement& X) const noexcept { return on_held ? p_obstacle : X * p_held; }
    /// The gap at another pose [m].
    double gapAt(const Placement& X) const noexcept {
        return (on_held ? Vec3(X.R * n_held) : n).dot(X * p_held - p_obstacle);
    }
    bool isLike(const ContactRow& other) const noexcept;
};

/// The row that keeps two faces apart which some motion from `X0` would take to each other: of where they come to each
/// other first. `X`: a pose on that way at which they are still apart, `there` how; `X1` the end of the way. rt-safe.
ContactRow rowBetween(const HullPair& pair, const Placement& X0, const Placement& X, const NearestHulls& there,
                      const Placement& X1) noexcept;

/// True if what a row holds is over the face whose plane it is against; a row that follows both faces always is. Past
/// an end of the face the plane goes on, and nothing is there. rt-safe.
bool isOverItsFace(const ContactRow& row, const HullPair& pair, const Placement& X) noexcept;

/// Sets a row to a new pose; false if its faces are too far from each other for it to mean anything. rt-safe.
bool refresh(ContactRow& row, const HullPair& pair, const Placement& X) noexcept;

}  // namespace passung::surface
