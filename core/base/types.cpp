#include "core/base/types.h"

#include <cmath>

namespace passung {

Vec3 rotationVector(const Quat& rotation) noexcept {
    // q and -q are the same rotation: the one with w >= 0 turns by at most pi.
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    const Vec3 v = sign * rotation.vec();
    const double s = v.norm();
    const double w = sign * rotation.w();
    if (s < 1e-12) return 2.0 * v;
    return (2.0 * std::atan2(s, w) / s) * v;
}

Quat rotationFromVector(const Vec3& v) noexcept {
    const double angle = v.norm();
    // sin(a/2)/a by its series where the quotient would lose digits.
    const double k = angle < 1e-6 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
    Quat q(std::cos(0.5 * angle), k * v.x(), k * v.y(), k * v.z());
    q.normalize();
    return q;
}

Quat rotationBetween(const Vec3& from, const Vec3& to) noexcept { return Quat::FromTwoVectors(from, to); }

bool isFinite(const Pose& pose) noexcept { return pose.p.allFinite() && pose.q.coeffs().allFinite(); }

bool isFinite(const Wrench& wrench) noexcept { return wrench.force.allFinite() && wrench.torque.allFinite(); }

bool isRotation(const Quat& q, double tolerance) noexcept { return std::abs(q.norm() - 1.0) < tolerance; }

bool isRigid(const Pose& pose, double tolerance) noexcept {
    return pose.p.allFinite() && isRotation(pose.q, tolerance);
}

}  // namespace passung
