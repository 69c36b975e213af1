#pragma once

#include <array>

#include "core/base/types.h"

namespace passung::model {

using TriangleCorners = std::array<Vec3, 3>;

/// The point of a segment that is nearest to `p`.
Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b);

/// The point of a triangle that is nearest to `p`; within rounding, unless the triangle is very long for its height.
Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace passung::model
