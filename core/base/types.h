#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace passung {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// A rigid transform. `X_AB` maps coordinates in frame B to coordinates in frame A: p_A = q·p_B + p.
/// Names of frames and of quantities: core/base/frames.h.
struct Pose {
    Quat q = Quat::Identity();  // unit quaternion
    Vec3 p = Vec3::Zero();      // [m]

    Vec3 operator*(const Vec3& point) const { return q * point + p; }
    Pose operator*(const Pose& other) const { return {q * other.q, q * other.p + p}; }
    Pose inverse() const {
        const Quat c = q.conjugate();
        return {c, -(c * p)};
    }
};

/// Linear and angular velocity of a frame, about its origin.
struct Twist {
    Vec3 v = Vec3::Zero();  // [m/s]
    Vec3 w = Vec3::Zero();  // [rad/s]
};

/// Force and moment about a stated point.
struct Wrench {
    Vec3 force = Vec3::Zero();   // [N]
    Vec3 torque = Vec3::Zero();  // [N·m]
};

/// Rotation vector of `rotation`, shortest way: |result| ≤ π [rad]. rt-safe.
Vec3 rotationVector(const Quat& rotation) noexcept;

/// Unit quaternion of the rotation vector `v` [rad]. rt-safe.
Quat rotationFromVector(const Vec3& v) noexcept;

/// The shortest rotation that turns `from` the way of `to`; both of any length but 0. Eigen's, which takes ten seconds
/// to compile wherever it is used: here once. rt-safe.
Quat rotationBetween(const Vec3& from, const Vec3& to) noexcept;

/// True if no component is NaN or infinite. rt-safe.
bool isFinite(const Pose& pose) noexcept;
bool isFinite(const Wrench& wrench) noexcept;

/// Of a quaternion's length: files and drivers give rounded numbers.
inline constexpr double kUnitTolerance = 1e-3;

/// True if `q` is finite and of length 1 ± `tolerance` (exclusive), so that normalising it loses nothing. rt-safe.
bool isRotation(const Quat& q, double tolerance = kUnitTolerance) noexcept;

/// True if `pose` is finite and its quaternion a rotation within `tolerance`. rt-safe.
bool isRigid(const Pose& pose, double tolerance = kUnitTolerance) noexcept;

}  // namespace passung
