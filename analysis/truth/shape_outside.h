#pragma once

#include <limits>
#include <span>

#include "analysis/truth/surface_pieces.h"
#include "core/shape/shape.h"

namespace passung::truth {

/// No point of the convex hull of `corners` is deeper in the shape than this [m], ≥ 0; `middle` is a point near its
/// middle. Shape frame. (Own.)
///   K a convex set that has no inner point of the solid: depth(p) ≤ dist(p, K), which is convex, so that over a convex
///   hull it is largest at a corner. The least over several K counts: the half-space beyond a face, or beyond a tangent
///   plane of a round one; the room in a bore, a pocket or a ring.
/// Where `middle` is nearest to such a K the bound is as near to the depth as the hull is small, and 0 for a hull of
/// any size in the room of a bore. Infinite for a sheet, which has no inside.
///   `enough`: where no bound is below it the answer is this, and sooner found.
double deepestOver(const shape::Shape& shape, std::span<const Vec3> corners, const Vec3& middle,
                   double enough = std::numeric_limits<double>::infinity());

/// The same of whatever has this extent about the z axis of the shape, by the same convex sets as far as they are
/// turned about it; infinite where the shape has none.
double deepestOver(const shape::Shape& shape, const AxialExtent& extent);

}  // namespace passung::truth
