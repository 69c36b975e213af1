#pragma once

#include "core/base/types.h"

namespace passung::closed_form {

inline constexpr double kOnAxis = 1e-12;  // so near to a face's axis no direction leads away from it [m]

/// A smooth face of a solid as a function of a point: its signed distance to the whole plane, cylinder, cone, sphere or
/// torus, positive outside the material. Its gradient has length 1. Cylinders and cones may be hollow: material outside
/// of them.
/// A helicoid is a thread's flank, about the z axis: r - radius = ∓ z' / slope with z' = z - lead φ - origin.z. Its
/// function is scaled so that its gradient is at most 1 long where the thread's other faces do not count. It jumps
/// amid the ridges: there the flank of the next turn begins to count.
struct Face {
    enum class Kind { Plane, Cylinder, Cone, Sphere, Torus, Helicoid };

    Kind kind = Kind::Plane;
    Vec3 origin = Vec3::Zero();     // on the plane; on the axis; the centre. Of a cone: where its radius is `radius`
    Vec3 axis = Vec3::UnitZ();      // unit. Of a plane: its normal, out of the material
    double radius = 0.0;            // of a torus: of the ring's circle [m]
    double tube = 0.0;              // of a torus: radius of its tube [m]
    double along = 0.0, out = 1.0;  // of a cone, a helicoid: parts of the gradient along the axis and away from it
    double pitch = 0.0;             // of a helicoid [m]
    double least = 0.0;             // of a helicoid: radius from which on the gradient is at most 1 long [m]
    bool hollow = false;
    bool about_z = false;  // its axis is the z axis

    bool isPlane() const noexcept { return kind == Kind::Plane; }
    /// Its function is convex: along a straight line it has one minimum.
    bool isConvex() const noexcept { return !hollow && kind != Kind::Torus && kind != Kind::Helicoid; }
};

Face plane(const Vec3& origin, const Vec3& normal);
Face cylinder(const Vec3& origin, const Vec3& axis, double radius, bool hollow = false);
/// `slope`: growth of the radius per length along the axis.
Face cone(const Vec3& origin, const Vec3& axis, double radius, double slope, bool hollow = false);
Face sphere(const Vec3& centre, double radius);
Face torus(const Vec3& centre, const Vec3& axis, double radius, double tube);

/// The flank of a ridge whose middle is at z = lead φ + `middle` and which is half as wide as the pitch at `radius`,
/// above it or below. The ridge widens on either side by `run` a length inwards, or outwards (hollow). `least`: radius
/// from which on the gradient is at most 1 long.
Face flank(double pitch, double radius, double run, double middle, bool above, bool hollow, double least);

// Of a flank at a height and an angle about the axis. rt-safe.
/// From its middle line, outwards along the axis: from the middle of its ridge to that of the next [m].
double fromFlank(const Face& flank, double z, double phi) noexcept;
/// A way that the point does not go before the flank of another turn counts [m].
double beforeNextRidge(const Face& flank, double z, double phi) noexcept;

/// Value and derivatives at a point; frame of the face. [m], 1, [1/m]
struct Jet {
    double value = 0.0;
    Vec3 gradient = Vec3::Zero();
    Mat3 hessian = Mat3::Zero();
};

// On an axis, where the direction away from it is not defined, it is taken to be one that is normal to the axis, and
// the curvature about the axis is left out. rt-safe.
double valueOf(const Face& face, const Vec3& p) noexcept;
Vec3 gradientOf(const Face& face, const Vec3& p) noexcept;
/// The bits of both, for less than each of them costs. The hessian is left out.
Jet slopedValueOf(const Face& face, const Vec3& p) noexcept;
Jet jetOf(const Face& face, const Vec3& p) noexcept;

}  // namespace passung::closed_form
