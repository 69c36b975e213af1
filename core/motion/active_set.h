#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace passung::motion {

/// A motion of a rigid body in one vector with the unit metre: (Δx, ρ Δφ).
using Motion = Eigen::Matrix<double, 6, 1>;

/// What a motion must obey: a · u ≥ bound. Nothing is set beforehand: a solver has hundreds and fills in a few.
struct MotionRow {
    Motion a;               // unit
    double bound;           // of now
    double b;               // what is asked for, if that can be had
    double length;          // of a before it was made unit; bound and b are per that
    double gradient;        // length of the contact's g
    std::uint32_t contact;  // its place in the manifold
    bool sphere;            // never asks for more than standing still
};

/// Rows N = Q R that hold a motion u = w + N λ, and their multipliers λ ≥ 0; independent, hence at most six.
/// Goldfarb and Idnani (1983), for a unit Hessian: constrained_motion.h.
class ActiveSet {
public:
    int size() const noexcept { return count_; }
    const MotionRow& row(int i) const noexcept { return rows_[static_cast<std::size_t>(i)]; }
    double lambda(int i) const noexcept { return lambdas_[static_cast<std::size_t>(i)]; }

    /// False if the row depends on those that are there, or these are six.
    bool tryAdd(const MotionRow& row, double lambda) noexcept;

    /// The motion that these rows leave of `wanted`, at their bounds; those that would pull are let go, the worst
    /// first.
    Motion start(const Motion& wanted) noexcept;

    enum class Taken { Yes, Infeasible, Capped };
    /// Takes `row` up, letting others go where they are in the way. `iterations` counts up to `most`.
    Taken takeUp(const MotionRow& row, Motion& u, int& iterations, int most) noexcept;

    static constexpr double kIndependent = 1e-7;  // a unit row is independent if more than this of it is left

private:
    void split(const Motion& a, Motion& z, Motion& r) const noexcept;
    void drop(int which) noexcept;
    Motion multipliersFor(const Motion& rhs) const noexcept;

    std::array<MotionRow, 6> rows_;
    std::array<double, 6> lambdas_{};
    Eigen::Matrix<double, 6, 6> Q_ = Eigen::Matrix<double, 6, 6>::Zero(), R_ = Eigen::Matrix<double, 6, 6>::Zero();
    int count_ = 0;
};

}  // namespace passung::motion
