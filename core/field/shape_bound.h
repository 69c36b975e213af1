#pragma once

#include <cstddef>

#include "core/base/types.h"
#include "core/field/surface_block.h"
#include "core/shape/shape.h"

namespace passung::field {

/// A rigorous bound of what trilinear interpolation of a shape's distance φ errs by in the cells of an octant of a
/// block (bits 1: x, 2: y, 4: z) [m]; at most about a cell. `block`: its node values are φ; `low`: its first corner;
/// `cell`: the edge of a cell [m]; only cells with a |node value| up to `reach` [m] count.
///   Cones. φ has the Lipschitz constant 1, so φ(p) ≤ U(p) = φ(o) + |p - o| for any point o. U is convex and
///   p = Σ w_i c_i with the trilinear weights, all ≥ 0: U(p) ≤ Σ w_i U(c_i), hence
///     φ(p) - Σ w_i φ_i ≤ max_i (U(c_i) - φ_i),  and in the same way  Σ w_i φ_i - φ(p) ≤ max_i (φ_i - φ(o) + |c_i -
///     o|).
///   o lies at a distance R from the middle of the cell, against the gradient for the first, along it for the second.
///   As long as φ changes by R on the way, that is as good as ½ t²/R, t half the diagonal of the cell; so R is as large
///   as curvature and walls allow.
///   Convex pieces. Where φ or -φ is the distance ψ of a convex solid all over the cell, ψ ≤ Σ w_i ψ_i, and the second
///   cone has all of the space outside the solid for its R: flat faces cost next to nothing.
double boundInterpolation(const shape::Shape& shape, const SurfaceBlock& block, const Vec3& low, double cell,
                          std::size_t octant, double reach);

}  // namespace passung::field
