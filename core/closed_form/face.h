#pragma once

#include "core/base/types.h"

namespace passung::closed_form {

/// A smooth face of a solid as a function of a point: its signed distance to the whole plane, cylinder, cone, sphere or
/// torus, positive outside the material. Its gradient has length 1. Cylinders and cones may be hollow: material outside
/// of them.
struct Face {
    enum class Kind { Plane, Cylinder, Cone, Sphere, Torus };

    Kind kind = Kind::Plane;
    Vec3 origin = Vec3::Zero();     // on the plane; on the axis; the centre. Of a cone: where its radius is `radius`
    Vec3 axis = Vec3::UnitZ();      // unit. Of a plane: its normal, out of the material
    double radius = 0.0;            // of a torus: of the ring's circle [m]
    double tube = 0.0;              // of a torus: radius of its tube [m]
    double along = 0.0, out = 1.0;  // of a cone: parts of the normal along the axis and away from it
    bool hollow = false;

    bool isPlane() const noexcept { return kind == Kind::Plane; }
    /// Its function is convex: along a straight line it has one minimum.
    bool isConvex() const noexcept { return !hollow && kind != Kind::Torus; }
};

Face plane(const Vec3& origin, const Vec3& normal);
Face cylinder(const Vec3& origin, const Vec3& axis, double radius, bool hollow = false);
/// `slope`: growth of the radius per length along the axis.
Face cone(const Vec3& origin, const Vec3& axis, double radius, double slope, bool hollow = false);
Face sphere(const Vec3& centre, double radius);
Face torus(const Vec3& centre, const Vec3& axis, double radius, double tube);

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
Jet jetOf(const Face& face, const Vec3& p) noexcept;

}  // namespace passung::closed_form
