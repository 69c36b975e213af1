#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"

namespace passung::shape {

inline double square(double x) { return x * x; }

/// Squared distance of (x, y) to the segment from (ax, ay) to (bx, by).
double squaredToSegment(double x, double y, double ax, double ay, double bx, double by);

/// A closed polygon around the origin, counter-clockwise from the +x axis; `on_axis`: the vertices on +x, +y, -x, -y.
/// It is seen from the origin, and its part in each quadrant from every corner of an axis-parallel rectangle around it.
struct Outline {
    std::vector<Eigen::Vector2d> points;
    std::array<std::size_t, 4> on_axis;
};

/// How finely the tessellation follows a profile and its slope.
struct ProfileSteps {
    int front = 1, back = 1;     // segments of the arc in the quadrants x > 0 and x < 0
    std::vector<double> levels;  // heights of the slope's rings, ascending; one if there is no slope
    double error = 0.0;          // chord error that this reaches [m]
};

// Cross-sections of pegs and pockets, in the plane of x and y, symmetric about the x axis [m].
//
// The slope of a profile is the surface of its 45° chamfer: the borders of grown(t) at the heights z = t, t from `low`
// to `high`. Where two parts of a border meet, each part is moved by itself: corners stay sharp (mitred).

/// Rectangle about the origin.
struct SquareProfile {
    double half_width, half_depth;  // x, y

    /// Every part of the border moved outward by t (inward if t < 0).
    SquareProfile grown(double t) const { return {half_width + t, half_depth + t}; }
    bool contains(double x, double y) const;                              // border excluded
    double squaredDistance(double x, double y) const;                     // to the region, 0 inside [m²]
    double squaredToBorder(double x, double y) const;                     // [m²]
    double squaredToSlope(const Vec3& p, double low, double high) const;  // [m²]

    ProfileSteps stepsFor(double low, double high, double chord_error) const;
    Outline outline(const ProfileSteps& steps) const;
};

/// A disc about the origin and the rectangle 0 ≤ x ≤ reach, |y| ≤ half_key; half_key < radius < reach.
struct KeyedProfile {
    double radius, half_key, reach;

    KeyedProfile grown(double t) const { return {radius + t, half_key + t, reach + t}; }
    bool contains(double x, double y) const;
    double squaredDistance(double x, double y) const;
    double squaredToBorder(double x, double y) const;
    double squaredToSlope(const Vec3& p, double low, double high) const;

    ProfileSteps stepsFor(double low, double high, double chord_error) const;
    Outline outline(const ProfileSteps& steps) const;

    /// x where circle and key meet.
    double crossing() const;
    /// Angle from the x axis to there [rad].
    double crossingAngle() const;
};

/// The cross-section of a peg's body, of a plate's pocket below the mouth.
SquareProfile profileOf(const SquarePeg& peg);
KeyedProfile profileOf(const KeyedPeg& peg);
SquareProfile profileOf(const SquareBorePlate& plate);
KeyedProfile profileOf(const KeyedBorePlate& plate);

}  // namespace passung::shape
