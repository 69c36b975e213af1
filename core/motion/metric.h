#pragma once

#include <cmath>

#include "core/base/types.h"
#include "core/motion/active_set.h"

namespace passung::motion {

/// A metric where the part is: world axes.
struct PlacedMetric {
    double radius = 1.0;
    Vec3 centre = Vec3::Zero();  // c [m]
    double across = 0.0;
    Vec3 axis = Vec3::Zero();
    bool whole = false;           // S is the matrix, and not what radius, across and axis say
    Mat3 S = {}, S_inverse = {};  // then

    bool isRound() const noexcept { return across == 0.0 && !whole; }
    /// S⁻¹ v.
    Vec3 perTurn(const Vec3& v) const noexcept {
        if (whole) return S_inverse * v;
        if (isRound()) return v / radius;
        return v / across + (1.0 / radius - 1.0 / across) * axis.dot(v) * axis;
    }
    /// S v, of `angle` times a unit vector.
    Vec3 tailOf(double angle, const Vec3& about) const noexcept {
        if (whole) return angle * (S * about);
        if (isRound()) return angle * radius * about;
        return angle * (across * about + (radius - across) * axis.dot(about) * axis);
    }
    /// Δφ of a motion [rad].
    Vec3 turnOf(const Motion& u) const noexcept { return perTurn(u.tail<3>()); }
    /// (n, S⁻¹ (P - c) × n).
    Motion rowOf(const Vec3& point, const Vec3& normal) const noexcept {
        Motion a;
        a << normal, perTurn((point - centre).cross(normal));
        return a;
    }
};

/// By what motions of a held part are measured: where the coupling's springs hold it, and how stiff they are against
/// turning.
///
/// Symbols: c the point of the part G that the hand holds, K, K_φ the coupling's stiffness, ρ² = K_φ/K.
///   u = (Δc, S Δφ),  S = ρ:   c moves by Δc while the part turns by Δφ about it,
/// so that the coupling's energy over K is ½|u - w|², w the motion that takes the part to where it is asked to be. A
/// contact at P with normal n is opened by (n, S⁻¹ (P - c) × n) · u. Limit case: c = 0 → the part's own origin.
///
/// Two hands hold one part at c_1 and c_2, each by a spring K and K_φ. With c halfway between them and d = c_1 - c the
/// energy's second derivatives by (Δc, Δφ) are, of springs that are not stretched,
///   2K · 1   and   2 K_φ + 2K (|d|² - d dᵀ),   and none across the two,
/// because the levers from c add up to zero. So S² = ρ² + |d|² - d dᵀ: ρ about the line between the hands, and
/// (ρ² + |d|²)^½ =: `across` about every axis across it; that is the energy's Cholesky factor, and u has its metric
/// over 2K. Springs that are pulled apart by s each along the line hold it stiffer across: |d| s more in the square.
///
/// A part that goes on moving has any S (pull.h).
struct Metric {
    double radius = 1.0;         // ρ [m], > 0: no turn of one radian is shorter
    Vec3 p_GC = Vec3::Zero();    // c, in the part [m]
    double across = 0.0;         // [m], ≥ ρ; 0: as ρ
    Vec3 axis_G = Vec3::Zero();  // of the line between two hands, in the part; unit
    bool whole = false;          // S is this, in part axes, symmetric
    Mat3 S_G = Mat3::Zero(), S_G_inverse = Mat3::Zero();

    /// Of a part that two hands hold; `pulled`: what springs that are stretched add to the square of `across` [m²].
    static Metric betweenHands(double rho, const Vec3& c_1, const Vec3& c_2, double pulled = 0.0) noexcept {
        const Vec3 d = 0.5 * (c_1 - c_2);
        const double arm = d.norm();
        if (!(arm > 0.0)) return {rho, c_1};
        return {rho, 0.5 * (c_1 + c_2), std::sqrt(rho * rho + arm * arm + pulled), d / arm};
    }
    PlacedMetric at(const Pose& X) const noexcept {
        PlacedMetric here;
        here.radius = radius;
        here.centre = centre(X);
        here.across = across;
        here.axis = across == 0.0 ? axis_G : Vec3(X.q * axis_G);
        if (whole) turnInto(here, X.q.toRotationMatrix());
        return here;
    }
    /// S where the part is turned by `R`. @pre whole
    void turnInto(PlacedMetric& here, const Mat3& R) const noexcept {
        here.whole = true;
        here.S = R * S_G * R.transpose();
        here.S_inverse = R * S_G_inverse * R.transpose();
    }
    /// Of c from the part's origin [m].
    double distance() const noexcept { return p_GC.norm(); }
    /// c, with the part at `X`.
    Vec3 centre(const Pose& X) const noexcept { return X * p_GC; }
    /// The part at `X` after `share` of `u`.
    Pose moved(const Pose& X, const Motion& u, double share = 1.0) const noexcept {
        const PlacedMetric here = at(X);
        Pose there{rotationFromVector(share * here.turnOf(u)) * X.q, here.centre + share * u.head<3>()};
        there.q.normalize();
        there.p -= there.q * p_GC;
        return there;
    }
    /// The motion that takes the part from `X` to `X_to`.
    Motion between(const Pose& X, const Pose& X_to) const noexcept {
        const PlacedMetric here = at(X);
        const Vec3 turn = rotationVector(X_to.q * X.q.conjugate());
        Motion u;
        u << centre(X_to) - here.centre, here.isRound() ? Vec3(radius * turn) : here.tailOf(1.0, turn);
        return u;
    }
    /// No point of a part that reaches so far from its origin goes farther [m].
    double wayOf(const Motion& u, double reach) const noexcept {
        return u.head<3>().norm() + u.tail<3>().norm() / radius * (reach + distance());
    }
};

}  // namespace passung::motion
