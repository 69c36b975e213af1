#include "core/closed_form/face.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::closed_form {

namespace {

/// A point about an axis.
struct AboutAxis {
    double z = 0.0, r = 0.0;
    Vec3 away;  // unit
};

AboutAxis aboutAxis(const Face& face, const Vec3& p) noexcept {
    const Vec3 d = p - face.origin;
    AboutAxis at;
    at.z = d.dot(face.axis);
    const Vec3 across = d - at.z * face.axis;
    at.r = across.norm();
    if (at.r > kOnAxis) {
        at.away = across / at.r;
    } else {
        const Vec3 other = std::abs(face.axis.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
        at.away = (other - other.dot(face.axis) * face.axis).normalized();
    }
    return at;
}

double signOf(const Face& face) noexcept { return face.hollow ? -1.0 : 1.0; }

/// Second derivative of the distance from an axis.
Mat3 aroundAxis(const Face& face, const AboutAxis& at) noexcept {
    if (at.r <= kOnAxis) return Mat3::Zero();
    const Vec3 tangent = face.axis.cross(at.away);
    return tangent * tangent.transpose() / at.r;
}

Face about(Face::Kind kind, const Vec3& origin, const Vec3& axis, double radius, bool hollow) {
    Face face;
    face.kind = kind;
    face.origin = origin;
    face.axis = axis.normalized();
    face.radius = radius;
    face.hollow = hollow;
    face.about_z = face.axis == Vec3::UnitZ() && origin.x() == 0.0 && origin.y() == 0.0;
    return face;
}

}  // namespace

Face plane(const Vec3& origin, const Vec3& normal) { return about(Face::Kind::Plane, origin, normal, 0.0, false); }

Face cylinder(const Vec3& origin, const Vec3& axis, double radius, bool hollow) {
    return about(Face::Kind::Cylinder, origin, axis, radius, hollow);
}

Face cone(const Vec3& origin, const Vec3& axis, double radius, double slope, bool hollow) {
    Face face = about(Face::Kind::Cone, origin, axis, radius, hollow);
    face.out = 1.0 / std::sqrt(1.0 + slope * slope);
    face.along = -slope * face.out;
    return face;
}

Face sphere(const Vec3& centre, double radius) {
    return about(Face::Kind::Sphere, centre, Vec3::UnitZ(), radius, false);
}

Face flank(double pitch, double radius, double run, double middle, bool above, bool hollow, double least) {
    const double quarter = 0.25 * pitch, lead = pitch / (2.0 * std::numbers::pi);
    const double cosine = 1.0 / std::sqrt(1.0 + run * run), sine = run * cosine;
    Face face = about(Face::Kind::Helicoid, {0.0, 0.0, above ? middle + quarter : middle - quarter}, Vec3::UnitZ(),
                      radius, hollow);
    const double scale = 1.0 / std::sqrt(1.0 + cosine * cosine * lead * lead / (least * least));
    face.along = scale * (above ? cosine : -cosine);
    face.out = scale * (hollow ? -sine : sine);
    face.pitch = pitch;
    face.least = least;
    return face;
}

Face torus(const Vec3& centre, const Vec3& axis, double radius, double tube) {
    Face face = about(Face::Kind::Torus, centre, axis, radius, false);
    face.tube = tube;
    return face;
}

namespace {

double leadOf(const Face& face) noexcept { return face.pitch / (2.0 * std::numbers::pi); }

}  // namespace

double fromFlank(const Face& flank, double z, double phi) noexcept {
    const double up = z - flank.origin.z() - leadOf(flank) * phi;
    const double away = flank.along > 0.0 ? up : -up;
    return away - flank.pitch * std::floor(away / flank.pitch + 0.25);
}

double beforeNextRidge(const Face& flank, double z, double phi) noexcept {
    return std::abs(flank.along) * (0.75 * flank.pitch - fromFlank(flank, z, phi));
}

double valueOf(const Face& face, const Vec3& p) noexcept {
    switch (face.kind) {
        case Face::Kind::Plane:
            return face.axis.dot(p - face.origin);
        case Face::Kind::Sphere:
            return (p - face.origin).norm() - face.radius;
        case Face::Kind::Helicoid:
            return face.out * (std::sqrt(p.x() * p.x() + p.y() * p.y()) - face.radius) +
                   std::abs(face.along) * fromFlank(face, p.z(), std::atan2(p.y(), p.x()));
        default:
            break;
    }
    const Vec3 d = p - face.origin;
    const double z = d.dot(face.axis);
    const double r = std::sqrt(std::max(0.0, (d - z * face.axis).squaredNorm()));
    switch (face.kind) {
        case Face::Kind::Cylinder:
            return signOf(face) * (r - face.radius);
        case Face::Kind::Cone:
            return signOf(face) * (face.out * (r - face.radius) + face.along * z);
        default:
            return std::hypot(r - face.radius, z) - face.tube;
    }
}

namespace {

/// `at` is unused by planes and spheres.
Vec3 gradientAt(const Face& face, const Vec3& p, const AboutAxis& at) noexcept {
    switch (face.kind) {
        case Face::Kind::Plane:
            return face.axis;
        case Face::Kind::Sphere: {
            const Vec3 d = p - face.origin;
            const double r = d.norm();
            return r > kOnAxis ? Vec3(d / r) : Vec3::UnitZ();
        }
        case Face::Kind::Cylinder:
            return signOf(face) * at.away;
        case Face::Kind::Cone:
            return signOf(face) * (face.out * at.away + face.along * face.axis);
        case Face::Kind::Helicoid: {
            const Vec3 around(-at.away.y(), at.away.x(), 0.0);
            return face.out * at.away + face.along * (face.axis - leadOf(face) / std::max(at.r, kOnAxis) * around);
        }
        case Face::Kind::Torus:
            break;
    }
    const double x = at.r - face.radius, length = std::hypot(x, at.z);
    return length > kOnAxis ? Vec3((x * at.away + at.z * face.axis) / length) : face.axis;
}

bool hasAxis(const Face& face) noexcept { return face.kind != Face::Kind::Plane && face.kind != Face::Kind::Sphere; }

}  // namespace

Vec3 gradientOf(const Face& face, const Vec3& p) noexcept {
    return gradientAt(face, p, hasAxis(face) ? aboutAxis(face, p) : AboutAxis{});
}

namespace {

/// As valueOf().
double valueAt(const Face& face, const Vec3& p, const AboutAxis& at) noexcept {
    if (face.kind == Face::Kind::Cylinder) return signOf(face) * (at.r - face.radius);
    if (face.kind == Face::Kind::Cone) return signOf(face) * (face.out * (at.r - face.radius) + face.along * at.z);
    return valueOf(face, p);
}

}  // namespace

Jet slopedValueOf(const Face& face, const Vec3& p) noexcept {
    const AboutAxis at = hasAxis(face) ? aboutAxis(face, p) : AboutAxis{};
    return {.value = valueAt(face, p, at), .gradient = gradientAt(face, p, at)};
}

Jet jetOf(const Face& face, const Vec3& p) noexcept {
    const AboutAxis at = hasAxis(face) ? aboutAxis(face, p) : AboutAxis{};
    Jet jet{.value = valueAt(face, p, at), .gradient = gradientAt(face, p, at)};
    switch (face.kind) {
        case Face::Kind::Plane:
            break;
        case Face::Kind::Sphere: {
            const double r = (p - face.origin).norm();
            if (r > kOnAxis) jet.hessian = (Mat3::Identity() - jet.gradient * jet.gradient.transpose()) / r;
            break;
        }
        case Face::Kind::Cylinder:
            jet.hessian = signOf(face) * aroundAxis(face, at);
            break;
        case Face::Kind::Cone:
            jet.hessian = signOf(face) * face.out * aroundAxis(face, at);
            break;
        case Face::Kind::Helicoid: {
            if (at.r <= kOnAxis) break;
            const Vec3 around(-at.away.y(), at.away.x(), 0.0);
            const Mat3 mixed = at.away * around.transpose();
            jet.hessian = face.out * aroundAxis(face, at) +
                          face.along * leadOf(face) / (at.r * at.r) * (mixed + mixed.transpose());
            break;
        }
        case Face::Kind::Torus: {
            const double x = at.r - face.radius, length = std::hypot(x, at.z);
            if (length <= kOnAxis) break;
            const Vec3 across = (x * face.axis - at.z * at.away) / length;
            jet.hessian = across * across.transpose() / length + (x / length) * aroundAxis(face, at);
            break;
        }
    }
    return jet;
}

}  // namespace passung::closed_form
