#pragma once

#include <span>

#include "core/motion/constrained_motion.h"
#include "core/surface/hull_distance.h"

namespace passung::surface {

/// True if both faces lie along the plane across `n`, up to what rubs as one. rt-safe.
bool lieAlong(const HullPair& pair, const Placement& X, const Vec3& n) noexcept;

/// Where two convex faces lie on each other: the overlap of both along `n`, cut off where they are farther apart than
/// `within` [m], as triangles around its middle.
/// `n`: a plane that sets them apart, unit, from the obstacle to the held part, in the frame of the obstacle's tree, as
/// are the pieces. `fineness`: of how many triangles at least; 0: one piece for all. How many pieces were written; what
/// has no room is left out. @pre lieAlong(). rt-safe.
std::size_t findPieces(const HullPair& pair, const Placement& X, const Vec3& n, double within, int fineness,
                       std::span<motion::TouchingPiece> pieces) noexcept;

}  // namespace passung::surface
