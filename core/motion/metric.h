#pragma once

#include "core/base/types.h"
#include "core/motion/active_set.h"

namespace passung::motion {

/// By what motions of a held part are measured: where the coupling's springs hold it, and how stiff they are against
/// turning.
///
/// Symbols: c the point of the part G that the hand holds, K, K_φ the coupling's stiffness, ρ² = K_φ/K.
///   u = (Δc, ρ Δφ):   c moves by Δc while the part turns by Δφ about it,
/// so that the coupling's energy over K is ½|u - w|², w the motion that takes the part to where it is asked to be. A
/// contact at P with normal n is opened by (n, (P - c) × n / ρ) · u. Limit case: c = 0 → the part's own origin.
struct Metric {
    double radius = 1.0;       // ρ [m], > 0
    Vec3 p_GC = Vec3::Zero();  // c, in the part [m]

    /// Of c from the part's origin [m].
    double distance() const noexcept { return p_GC.norm(); }
    /// c, with the part at `X`.
    Vec3 centre(const Pose& X) const noexcept { return X * p_GC; }
    /// Δφ of a motion [rad].
    Vec3 turnOf(const Motion& u) const noexcept { return u.tail<3>() / radius; }
    /// The part at `X` after `share` of `u`.
    Pose moved(const Pose& X, const Motion& u, double share = 1.0) const noexcept {
        Pose there{rotationFromVector(share * turnOf(u)) * X.q, centre(X) + share * u.head<3>()};
        there.q.normalize();
        there.p -= there.q * p_GC;
        return there;
    }
    /// The motion that takes the part from `X` to `X_to`.
    Motion between(const Pose& X, const Pose& X_to) const noexcept {
        Motion u;
        u << centre(X_to) - centre(X), radius * rotationVector(X_to.q * X.q.conjugate());
        return u;
    }
    /// (n, (P - c) × n / ρ), with the part at `X`.
    Motion rowOf(const Pose& X, const Vec3& point, const Vec3& normal) const noexcept {
        Motion a;
        a << normal, (point - centre(X)).cross(normal) / radius;
        return a;
    }
    /// No point of a part that reaches so far from its origin goes farther [m].
    double wayOf(const Motion& u, double reach) const noexcept {
        return u.head<3>().norm() + u.tail<3>().norm() / radius * (reach + distance());
    }
};

}  // namespace passung::motion
