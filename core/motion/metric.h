#pragma once

#include <array>
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

    bool isRound() const noexcept { return across == 0.0; }
    /// S⁻¹ v.
    Vec3 perTurn(const Vec3& v) const noexcept {
        if (isRound()) return v / radius;
        return v / across + (1.0 / radius - 1.0 / across) * axis.dot(v) * axis;
    }
    /// S v, of `angle` times a unit vector.
    Vec3 tailOf(double angle, const Vec3& about) const noexcept {
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
struct Metric {
    double radius = 1.0;         // ρ [m], > 0
    Vec3 p_GC = Vec3::Zero();    // c, in the part [m]
    double across = 0.0;         // [m], ≥ ρ; 0: as ρ
    Vec3 axis_G = Vec3::Zero();  // of the line between two hands, in the part; unit

    /// Of a part that two hands hold; `pulled`: what springs that are stretched add to the square of `across` [m²].
    static Metric betweenHands(double rho, const Vec3& c_1, const Vec3& c_2, double pulled = 0.0) noexcept {
        const Vec3 d = 0.5 * (c_1 - c_2);
        const double arm = d.norm();
        if (!(arm > 0.0)) return {rho, c_1};
        return {rho, 0.5 * (c_1 + c_2), std::sqrt(rho * rho + arm * arm + pulled), d / arm};
    }
    PlacedMetric at(const Pose& X) const noexcept {
        return {radius, centre(X), across, across == 0.0 ? axis_G : Vec3(X.q * axis_G)};
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

/// What two hands draw a part by: a spring each, and what hangs from both.
struct TwoSprings {
    struct Spring {
        Pose X_WT;                 // where its hand asks the part to be
        Vec3 p_GC = Vec3::Zero();  // where it holds it, in the part [m]
    };
    std::array<Spring, 2> springs;
    double turn = 0.0;         // K_φ/K [m²], ≥ 0
    Vec3 load = Vec3::Zero();  // f/K [m], world
    Vec3 p_GM = Vec3::Zero();  // where that acts, in the part [m]

    /// Minus the energy's gradient over 2K, with the part at `X`, by a motion in `metric` (Metric::betweenHands):
    ///   w = (½ (Σ t_i - c_i + f/K),  ½ S⁻¹ (Σ (c_i - c) × (t_i - c_i) + K_φ/K ψ_i + (m - c) × f/K)),
    /// t_i where the hand asks c_i to be, ψ_i the turn from the part to where it asks it to be. Exact at any stretch,
    /// so that where the rows of contacts hold w, all forces balance.
    Motion wantedAt(const Metric& metric, const Pose& X) const noexcept {
        const PlacedMetric here = metric.at(X);
        Vec3 along = load, about = (X * p_GM - here.centre).cross(load);
        for (const Spring& spring : springs) {
            const Vec3 c = X * spring.p_GC, stretch = spring.X_WT * spring.p_GC - c;
            along += stretch;
            about += (c - here.centre).cross(stretch) + turn * rotationVector(spring.X_WT.q * X.q.conjugate());
        }
        Motion w;
        w << 0.5 * along, here.perTurn(0.5 * about);
        return w;
    }

    /// What their stretch adds to the square of Metric::across, with the part at `X`: > 0 where they are pulled apart
    /// [m²].
    double pulledAt(const Pose& X) const noexcept {
        const Vec3 c = 0.5 * (X * springs[0].p_GC + X * springs[1].p_GC);
        double pulled = 0.0;
        for (const Spring& spring : springs) {
            const Vec3 held = X * spring.p_GC;
            pulled += 0.5 * (held - c).dot(spring.X_WT * spring.p_GC - held);
        }
        return pulled;
    }

    static constexpr int kMostSteps = 20;
    static constexpr double kSettled = 1e-12;  // [m]
    /// Where both springs hold the part without contacts: from `X` on by steps of `w`, which is the way there but for
    /// what the metric errs by.
    Pose restFrom(const Metric& metric, Pose X) const noexcept {
        for (int i = 0; i < kMostSteps; ++i) {
            const Motion w = wantedAt(metric, X);
            X = metric.moved(X, w);
            if (!(w.norm() > kSettled)) break;
        }
        return X;
    }
};

}  // namespace passung::motion
