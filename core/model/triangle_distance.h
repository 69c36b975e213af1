#pragma once

#include <array>

#include "core/base/types.h"

namespace passung::model {

using TriangleCorners = std::array<Vec3, 3>;

/// The point of a segment that is nearest to `p`.
Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b);

/// The point of a triangle that is nearest to `p`; within rounding, unless the triangle is very long for its height.
Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A point of one triangle and one of another.
struct TrianglePair {
    double distance = 0.0;  // of the two [m]
    Vec3 on_first = Vec3::Zero(), on_second = Vec3::Zero();
};

/// The nearest points of two triangles if they are nearer than `limit`, else some pair that is not; distance 0, up to
/// rounding, if they meet.
///   The distance of two triangles that do not meet is that of a corner and the other triangle or of two edges; if they
/// meet, an edge of one passes through the other.
TrianglePair closestPair(const TriangleCorners& first, const TriangleCorners& second, double limit);

}  // namespace passung::model
