#pragma once

#include "core/tick/contact_query.h"

namespace passung::tick {

/// A motion of a rigid body in one vector with the unit metre: (Δx, ρ Δφ).
using Motion = Eigen::Matrix<double, 6, 1>;

struct ConstrainedMotion {
    Motion u = Motion::Zero();
    int rows = 0;           // contacts that became constraints
    bool converged = true;  // false: the cap of rows or sweeps was reached
};

/// The motion nearest to `wanted` that obeys  a_i · u ≥ keep_out - φ_i  for all contacts of `manifold`,
///   a_i = (g_i, (r_i × g_i)/ρ),  r_i = P_i - p_WO:
/// step #4 of god_object_heuristic.h. `keep_out` [m] is the φ that a contact must keep (slightly negative).
///   min ½|u - wanted|²  s.t. rows.  Dual: u = wanted + Σ λ_i a_i, λ_i ≥ 0; projected Gauss-Seidel sweeps
///   λ_i ← max(0, λ_i + (b_i - a_i·u)/(a_i·a_i)). The most violated contact joins the rows until none is violated by
///   more than kTolerance; if that is reached, every contact outside the rows is satisfied as well.
/// The sweeps or rows may end before: `converged` is then false, contacts may still be violated, and the caller has to
/// test the pose. Opposite rows (a peg between two walls) make the sweeps slow, so that tight fits often end there.
/// Limit cases: no contact violated → wanted. One row → the projection onto its plane. rt-safe, bounded.
ConstrainedMotion constrainMotion(const Motion& wanted, const ContactManifold& manifold, const Vec3& p_WO,
                                  double metric_radius, double keep_out, int max_rows) noexcept;

}  // namespace passung::tick
