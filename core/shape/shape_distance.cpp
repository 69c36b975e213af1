#include <algorithm>
#include <cmath>

#include "core/shape/profile.h"
#include "core/shape/shape.h"
#include "core/shape/thread_surface.h"

namespace passung::shape {

namespace {

/// Signed distance to a box with half edges h about the origin, from the excesses q = |p| - h.
template <class Excess>
double fromExcess(const Excess& q) {
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

double distanceTo(const Sphere& s, const Vec3& p) { return p.norm() - 0.5 * s.diameter; }

double distanceTo(const Box& b, const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - 0.5 * Vec3(b.width, b.depth, b.height);
    return fromExcess(q);
}

double distanceTo(const Cylinder& c, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const Eigen::Vector2d q(r - 0.5 * c.diameter, std::abs(p.z()) - 0.5 * c.length);
    return fromExcess(q);
}

double distanceTo(const Torus& t, const Vec3& p) {
    // In the half plane of p, the distance to the tube's circle.
    const double from_ring = std::sqrt(square(p.x()) + square(p.y())) - 0.5 * t.diameter;
    return std::sqrt(square(from_ring) + square(p.z())) - 0.5 * t.tube_diameter;
}

double distanceTo(const Sheet& s, const Vec3& p) {
    const double dx = std::max(std::abs(p.x()) - 0.5 * s.width, 0.0);
    const double dy = std::max(std::abs(p.y()) - 0.5 * s.depth, 0.0);
    return std::sqrt(square(dx) + square(dy) + square(p.z()));
}

/// A solid of revolution: the nearest surface point lies in the half plane of p, so the distance to the profile in
/// (r, z) is the distance. The profile is convex: inside means below all of its lines.
double distanceTo(const Peg& peg, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const double z = p.z();
    const double radius = 0.5 * peg.diameter, c = peg.chamfer, length = peg.length;
    const double d2 = std::min(
        {squaredToSegment(r, z, 0.0, 0.0, radius - c, 0.0), squaredToSegment(r, z, radius - c, 0.0, radius, c),
         squaredToSegment(r, z, radius, c, radius, length), squaredToSegment(r, z, radius, length, 0.0, length)});
    const bool inside = z > 0.0 && z < length && r < radius && r - z < radius - c;
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

/// Squared distance to a horizontal rectangle (half edges hx, hy, about the axis) without the open disc of `hole`
/// inside it, `dz` above or below. In the plane: from outside the rectangle its border is nearest, and the hole does
/// not reach that; from inside the hole its rim is.
double squaredToFace(double ex, double ey, double r, double hole, double dz) {
    if (r < hole) return square(hole - r) + square(dz);
    return square(std::max(ex, 0.0)) + square(std::max(ey, 0.0)) + square(dz);
}

/// Least distance over the pieces of the surface; the sign from membership. Pieces: top face, bottom face, the nearer
/// of each pair of sides, and (in r, z) chamfer cone, bore wall, floor of a blind bore.
double distanceTo(const BorePlate& plate, const Vec3& p) {
    const double r = std::sqrt(square(p.x()) + square(p.y()));
    const double z = p.z();
    const double bore = 0.5 * plate.bore_diameter, mouth = bore + plate.chamfer;
    const bool through = plate.bore_depth >= plate.height;
    const double floor_z = through ? -plate.height : -plate.bore_depth;
    // How far p is beyond the planes of the box, per axis; ≤ 0 between them.
    const double ex = std::abs(p.x()) - 0.5 * plate.width;
    const double ey = std::abs(p.y()) - 0.5 * plate.depth;
    const double ez = std::max(z, -plate.height - z);

    const double side_z2 = square(std::max(ez, 0.0));
    double d2 = std::min(square(ex) + square(std::max(ey, 0.0)), square(ey) + square(std::max(ex, 0.0))) + side_z2;
    d2 = std::min(d2, squaredToFace(ex, ey, r, mouth, z));
    d2 = std::min(d2, squaredToFace(ex, ey, r, through ? bore : 0.0, z + plate.height));
    d2 = std::min(d2, squaredToSegment(r, z, bore, -plate.chamfer, bore, floor_z));
    if (plate.chamfer > 0.0) d2 = std::min(d2, squaredToSegment(r, z, mouth, 0.0, bore, -plate.chamfer));
    if (!through) d2 = std::min(d2, square(std::max(r - bore, 0.0)) + square(z - floor_z));

    const bool in_cavity = (through || z > floor_z) && r < bore + std::max(0.0, z + plate.chamfer);
    const bool inside = ex < 0.0 && ey < 0.0 && ez < 0.0 && !in_cavity;
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

/// Distance along one axis to the interval from `low` to `high`.
double beyond(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

/// A profile drawn along z with a chamfered tip. Surfaces: tip face, end face, wall, slope; each is a region or a
/// border of the profile at one height, a border over an interval of heights, or the slope, so each distance is exact
/// and their least is the distance to the solid's surface. Inside: within the border at the point's height.
template <class Profile>
double distanceToPeg(const Profile& profile, double length, double chamfer, const Vec3& p) {
    const double x = p.x(), y = p.y(), z = p.z();
    double d2 = std::min({profile.grown(-chamfer).squaredDistance(x, y) + square(z),
                          profile.squaredDistance(x, y) + square(z - length),
                          profile.squaredToBorder(x, y) + square(beyond(z, chamfer, length))});
    if (chamfer > 0.0) d2 = std::min(d2, profile.squaredToSlope(p - Vec3(0.0, 0.0, chamfer), -chamfer, 0.0));
    const bool inside = z > 0.0 && z < length && profile.grown(std::min(0.0, z - chamfer)).contains(x, y);
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

/// A block with a pocket. As for the bore plate, least distance over the pieces of the surface: sides, top and bottom
/// face (rectangles, less the pocket's profile), the pocket's wall, slope and floor.
template <class Plate>
double distanceToPocketPlate(const Plate& plate, const Vec3& p) {
    const auto profile = profileOf(plate);
    const double x = p.x(), y = p.y(), z = p.z(), chamfer = plate.chamfer;
    const bool through = plate.bore_depth >= plate.height;
    const double floor_z = through ? -plate.height : -plate.bore_depth;
    const SquareProfile block{0.5 * plate.width, 0.5 * plate.depth};
    // The pocket lies inside the block: from outside the rectangle its border is nearest, from inside the hole the
    // hole's.
    const auto squaredToPlane = [&](const auto& hole) {
        return hole.contains(x, y) ? hole.squaredToBorder(x, y) : block.squaredDistance(x, y);
    };
    const auto mouth = profile.grown(chamfer);
    const double bottom = through ? squaredToPlane(profile) : block.squaredDistance(x, y);
    double d2 = std::min({block.squaredToBorder(x, y) + square(beyond(z, -plate.height, 0.0)),
                          squaredToPlane(mouth) + square(z), bottom + square(z + plate.height),
                          profile.squaredToBorder(x, y) + square(beyond(z, floor_z, -chamfer))});
    if (chamfer > 0.0) d2 = std::min(d2, profile.squaredToSlope(p + Vec3(0.0, 0.0, chamfer), 0.0, chamfer));
    if (!through) d2 = std::min(d2, profile.squaredDistance(x, y) + square(z - floor_z));

    const bool in_cavity = (through || z > floor_z) && profile.grown(std::max(0.0, z + chamfer)).contains(x, y);
    const bool inside = block.contains(x, y) && z < 0.0 && z > -plate.height && !in_cavity;
    return inside ? -std::sqrt(d2) : std::sqrt(d2);
}

double distanceTo(const SquarePeg& peg, const Vec3& p) {
    return distanceToPeg(profileOf(peg), peg.length, peg.chamfer, p);
}
double distanceTo(const KeyedPeg& peg, const Vec3& p) {
    return distanceToPeg(profileOf(peg), peg.length, peg.chamfer, p);
}
double distanceTo(const SquareBorePlate& plate, const Vec3& p) { return distanceToPocketPlate(plate, p); }
double distanceTo(const KeyedBorePlate& plate, const Vec3& p) { return distanceToPocketPlate(plate, p); }

}  // namespace

double signedDistance(const Shape& shape, const Vec3& point) {
    return std::visit([&](const auto& s) { return distanceTo(s, point); }, shape);
}

}  // namespace passung::shape
