#pragma once

#include <array>

#include "core/motion/metric.h"

namespace passung::motion {

/// What keeps a part moving: its mass over the square of a tick T, as a spring to where it would go by itself.
///   ½ m/T² |m_A - m_G|² + ½ ψ · R_A I R_Aᵀ/T² ψ,  ψ = log(R_A R_Gᵀ),
/// m_A, R_A where the centre of mass and the part would be after this tick at the speed that it has: the least of that
/// and of all springs is a step of the implicit Euler rule. A turn goes on about its axis: no gyroscopic torque.
struct Momentum {
    double mass = 0.0;              // m/(K T²); 0: none
    Mat3 inertia_G = Mat3::Zero();  // I/(K T²) about the centre of mass, part axes [m²]
    Pose X_WA;
};

/// What pulls a held part beside contacts: a spring of each hand that holds it, what hangs from them, and what keeps it
/// moving. All over the springs' stiffness K.
struct Pull {
    struct Spring {
        Pose X_WT;                 // where its hand asks the part to be
        Vec3 p_GC = Vec3::Zero();  // where it holds it, in the part [m]
    };
    std::array<Spring, 2> springs = {};
    int count = 2;             // of them: 1 or 2
    double spring = 1.0;       // k: stiffness of each, over K
    double turn = 0.0;         // ρ²: of each against turning, over K [m²], ≥ 0
    Vec3 load = Vec3::Zero();  // f/K [m], world
    Vec3 p_GM = Vec3::Zero();  // centre of mass, where that acts, in the part [m]
    Momentum momentum = {};

    /// How stiff all of it is against moving, over K.
    double stiffness() const noexcept { return count * spring + momentum.mass; }

    bool goesOn() const noexcept { return momentum.mass > 0.0; }

    /// What momentum does to the part at `X`: about its centre of mass, world axes, over K.
    Wrench pushOnwards(const Pose& X) const noexcept {
        const Quat& R = momentum.X_WA.q;
        const Vec3 turns = R.conjugate() * rotationVector(R * X.q.conjugate());
        return {momentum.mass * (momentum.X_WA * p_GM - X * p_GM), R * Vec3(momentum.inertia_G * turns)};
    }

    /// Minus the energy's gradient over K times its stiffness, with the part at `X`, by a motion in `metric`, whose
    /// centre is c:
    ///   w = 1/s (Σ k (t_i - c_i) + f/K + F,  S⁻¹ (Σ (c_i - c) × k (t_i - c_i) + ρ² ψ_i + (m - c) × (f/K + F) + T)),
    /// s the stiffness, t_i where the hand asks c_i to be, ψ_i the turn from the part to where it asks it to be, F and
    /// T what momentum does. Exact at any stretch and in any metric, so that where the rows of contacts hold w, all
    /// forces balance.
    Motion wantedAt(const Metric& metric, const Pose& X) const noexcept {
        const PlacedMetric here = metric.at(X);
        const auto [along, about] = gradientAt(X, here.centre);
        const double share = 1.0 / stiffness();
        Motion w;
        w << share * along, here.perTurn(share * about);
        return w;
    }

    /// The metric of a part with momentum. The energy's second derivatives about the mean of the points that are held
    /// and the centre of mass, weighted by k, k and M = m/(K T²), have none across moving and turning; of turning they
    /// are,
    ///   n ρ² + I/(K T²) + Σ_i w_i (|d_i|² - d_i d_iᵀ),   d_i from that mean, w_i its weights, n hands,
    /// and over the stiffness the square of S. Where springs are stretched they are a little more.
    Metric movingMetric() const noexcept;

    /// What two springs' stretch adds to the square of Metric::across, with the part at `X`: > 0 where they are pulled
    /// apart [m²].
    double pulledAt(const Pose& X) const noexcept {
        const Vec3 c = 0.5 * (X * springs[0].p_GC + X * springs[1].p_GC);
        double pulled = 0.0;
        for (const Spring& own : springs) {
            const Vec3 held = X * own.p_GC;
            pulled += 0.5 * (held - c).dot(own.X_WT * own.p_GC - held);
        }
        return pulled;
    }

    static constexpr int kMostSteps = 20;
    static constexpr double kSettled = 1e-12;  // [m]
    /// Where all of it balances without contacts: from `X` on by steps of `w`, which is the way there but for what the
    /// metric errs by.
    Pose restFrom(const Metric& metric, Pose X) const noexcept;

private:
    struct Gradient {
        Vec3 along, about;
    };
    /// Minus it, over K: of moving, and of turning about `centre`.
    Gradient gradientAt(const Pose& X, const Vec3& centre) const noexcept {
        Gradient sum{load, (X * p_GM - centre).cross(load)};
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            const Spring& own = springs[i];
            const Vec3 c = X * own.p_GC, stretch = spring * (own.X_WT * own.p_GC - c);
            sum.along += stretch;
            sum.about += (c - centre).cross(stretch) + turn * rotationVector(own.X_WT.q * X.q.conjugate());
        }
        if (goesOn()) {
            const Wrench onwards = pushOnwards(X);
            sum.along += onwards.force;
            sum.about += (X * p_GM - centre).cross(onwards.force) + onwards.torque;
        }
        return sum;
    }
};

}  // namespace passung::motion
