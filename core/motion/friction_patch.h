#pragma once

#include "core/motion/friction.h"

namespace passung::motion {

// Geometry of a patch of contacts that rub as one. rt-safe.

/// The friction of `patch` in the tangents of a normal that differs a little.
Vec3 turned(const FrictionPatch& patch, const Vec3& normal) noexcept;

/// How a patch slips while the body moves by `motion`: along the two tangents and by its torsion [m].
Vec3 slipOf(const Surroundings& around, const FrictionPatch& patch, const Motion& motion) noexcept;

/// Mean distance from the centre of pressure of the points that `patch` touches after `u`, under their pressure.
double effectiveRadius(const Surroundings& around, const FrictionPatch& patch, const Motion& u) noexcept;

}  // namespace passung::motion
