#pragma once

#include "core/base/types.h"

namespace passung::contact {

/// The gradient of φ at a face's sample that lies a little inside the other part, without the turn that trilinear
/// values give it beside a rim. (Own.)
///
/// In the last cell (edge s) before one or two sides of a part, whose outer nodes lie on these, φ at depth z under a
/// face is read as -z ξ η, ξ and η the ways to the sides per s: right at the inner nodes, 0 at the outer ones. With n
/// the face's inward normal its gradient is
///   g = ξ η n_out + (z/s)(ξ, η) aside,   |aside| · along = |φ| √(ξ² + η²)/s ≤ √2 |φ|/s.
/// The part aside is none of the surface's: where a sample enters that cell it bears a share of the press, and z/s of
/// that is felt along the plane. So a gradient that is turned by no more than this is taken along the sample's own
/// normal, which the field cannot tell from it.
///   What is really turned by so little is told too straight by at most √2 |φ|/s: after a step of s/2 such a point is
/// deeper by less than it is already, and the step is looked at like any other.
/// Limit cases: φ ≥ 0, or deeper than kShallow · s → g. Nothing aside → g. rt-safe.
inline Vec3 withoutTurnOfRim(const Vec3& gradient, const Vec3& normal, double phi, double cell) noexcept {
    constexpr double kShallow = 0.1;    // beyond it may be another side's
    constexpr double kAtCorner = 1.42;  // √2, and rounding
    if (!(phi < 0.0) || phi < -kShallow * cell) return gradient;
    const double along = -normal.dot(gradient);
    const Vec3 straight = -along * normal;
    return (gradient - straight).norm() * along <= kAtCorner * -phi / cell ? straight : gradient;
}

}  // namespace passung::contact
