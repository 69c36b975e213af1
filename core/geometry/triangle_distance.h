#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/types.h"

namespace passung::geometry {

using TriangleCorners = std::array<Vec3, 3>;

inline Vec3 centroid(const TriangleCorners& t) { return (t[0] + t[1] + t[2]) / 3.0; }

/// How far the farthest corner is from `p`.
inline double farthestCorner(const Vec3& p, const TriangleCorners& t) {
    return std::sqrt(std::max({(t[0] - p).squaredNorm(), (t[1] - p).squaredNorm(), (t[2] - p).squaredNorm()}));
}

/// The point of a segment that is nearest to `p`.
Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b);

/// The point of a triangle that is nearest to `p`; within rounding, unless the triangle is very long for its height.
Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A point of one triangle and one of another.
struct TrianglePair {
    double distance = 0.0;  // of the two [m]
    Vec3 on_first = Vec3::Zero(), on_second = Vec3::Zero();
};

/// A direction in which `first` lies farther than `limit` behind all of `second`: across two points that are nearest to
/// each other, but for what more projections would still change; false if none is found.
bool findWay(const TriangleCorners& first, const TriangleCorners& second, double limit, Vec3& way);

/// The nearest points of two triangles if they are nearer than `limit`, else some pair that is not; distance 0, up to
/// rounding, if they meet.
///   The distance of two triangles that do not meet is that of a corner and the other triangle or of two edges; if they
/// meet, an edge of one passes through the other.
TrianglePair closestPair(const TriangleCorners& first, const TriangleCorners& second, double limit);

/// A lower bound of the distance of some closed set from a triangle whose corners are at least `l` from it, if there is
/// one above zero; else -∞. One whose square is `enough` will do.
///   d the distance, q the points of the set: d² - |p|² = min_q (|q|² - 2 p·q) is concave. With p = Σ λ_i v_i on the
/// triangle therefore  d(p)² ≥ Σ λ_i l_i² - Σ λ_i |v_i - p|²,  convex in p: its least value lies in the triangle where
/// its slope is zero, or on an edge. No more than a third of the longest edge's square is taken away.
double leastDistance(const TriangleCorners& t, const std::array<double, 3>& l, double enough);

}  // namespace passung::geometry
