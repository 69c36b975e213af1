#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"

namespace passung::truth {

/// A sector about a z axis: the directions within `half_angle` of its middle.
struct Sector {
    Eigen::Vector2d middle{1.0, 0.0};      // across the axis, length 1
    double half_angle = std::numbers::pi;  // [rad], to pi: the whole turn
    double cosine = -1.0, sine = 0.0;      // of it

    std::array<Sector, 2> halves() const;
    /// The largest a . u for the directions u of the sector.
    double most(const Eigen::Vector2d& a) const {
        const double along = a.dot(middle), length = a.norm();
        if (along >= length * cosine) return length;
        return along * cosine + std::abs(a.y() * middle.x() - a.x() * middle.y()) * sine;
    }
    double least(const Eigen::Vector2d& a) const { return -most(-a); }
    /// That of the doubled angles.
    Sector doubled() const;
};

/// A piece of a surface that is turned about the z axis of its shape, of a mantle, a cone, a ring or a disc: what lies
/// in a sector between two circles. Exact: no chord.
struct TurnedPiece {
    struct Circle {
        double radius, height;  // [m], radius ≥ 0
    };
    Sector sector;
    Circle low, high;

    /// Is the sector narrow enough for a hull?
    bool hasHull() const { return sector.cosine > 0.7; }
    /// The piece is in their convex hull: of each circle the ends of its arc, and where the tangents at these and at
    /// its middle meet. @pre hasHull().
    std::array<Vec3, 8> corners() const;
    /// A point of the surface.
    Vec3 middle() const;
    double radius() const;  // of a ball about the middle that holds the piece [m]
    double lengthAround() const;
    double lengthAlong() const;
    /// In two, by half-planes, or by a circle.
    std::array<TurnedPiece, 2> halvesAround() const;
    std::array<TurnedPiece, 2> halvesAlong() const;
};

/// Where a turned piece is, as seen from another z axis: no point of it is outside these. r is a point's distance from
/// that axis.
struct AxialExtent {
    double least_radius = 0.0, most_radius = 0.0;  // r [m]
    double least_height = 0.0, most_height = 0.0;  // z
    double least_slope = 0.0, most_slope = 0.0;    // r - z
};

/// Extents of turned pieces seen from another z axis. (Own.) With the pose X: R, p and columns a, b of R's upper left
/// 2 x 2 block, a point of a circle of radius q in the direction u = (cos f, sin f) is off the other axis by
///   e + q (a cos f + b sin f),  e the centre's offset, and
///   r² = e² + q² (a² + b²) / 2 + 2 q (e·a, e·b)·u + q² ((a² - b²) / 2, a·b)·(cos 2f, sin 2f):
/// what is linear in u and in the doubled direction is largest and least in a sector in closed form. Near axes that are
/// nearly parallel the second is tiny: then a bound is exact for a whole turn. Between two circles, along a straight
/// line, r and r - z are convex: largest at an end; r² is short of its chord by at most a quarter of the line's squared
/// length across the axis.
class AxialView {
public:
    /// X: of the piece's shape in the frame of the axis.
    explicit AxialView(const Pose& X);
    AxialExtent extentOf(const TurnedPiece& piece) const;

private:
    struct OfCircle {
        Eigen::Vector2d centre;              // off the axis [m]
        double least_squared, most_squared;  // r²
        AxialExtent extent;
    };
    OfCircle see(const TurnedPiece::Circle& circle, const Sector& sector, const Sector& doubled) const;

    Mat3 R_;
    Vec3 p_;
    Eigen::Vector2d a_, b_, difference_;
    double mean_;
};

/// A convex flat piece, its corners in turn.
using FlatPiece = std::vector<Vec3>;

/// Pieces that cover the whole surface of a shape and have no point off it. A point may be in several.
struct SurfacePieces {
    std::vector<TurnedPiece> turned;
    std::vector<FlatPiece> flat;  // at most 6 corners each

    /// Empty for kinds whose surface is not made of such pieces.
    static SurfacePieces of(const shape::Shape& shape);
    bool empty() const { return turned.empty() && flat.empty(); }
};

}  // namespace passung::truth
