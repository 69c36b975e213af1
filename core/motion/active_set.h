#pragma once

#include <array>
#include <cstdint>

#include "core/base/types.h"

namespace passung::motion {

/// A motion of a rigid body in one vector with the unit metre: (Δx, ρ Δφ).
using Motion = Eigen::Matrix<double, 6, 1>;

using MotionMatrix = Eigen::Matrix<double, 6, 6>;

/// Motions of several bodies in one vector, six numbers a body; N = 6: of one.
template <int N>
using MotionOf = Eigen::Matrix<double, N, 1>;

/// What a motion must obey: a · u ≥ bound. Nothing is set beforehand: a solver has hundreds and fills in a few.
template <int N>
struct MotionRowOf {
    MotionOf<N> a;          // unit
    double bound;           // of now
    double b;               // what is asked for, if that can be had
    double length;          // of a before it was made unit; bound and b are per that
    double gradient;        // length of the contact's g
    std::uint32_t contact;  // its place in the manifold
    bool sphere;            // never asks for more than standing still
};

using MotionRow = MotionRowOf<6>;

/// Rows N = Q R that hold a motion u = w + N λ, and their multipliers λ ≥ 0; independent, hence at most as many as the
/// motion has numbers. Goldfarb and Idnani (1983), for a unit Hessian: constrained_motion.h.
template <int N>
class ActiveSetOf {
public:
    using Motion = MotionOf<N>;
    using MotionRow = MotionRowOf<N>;

    int size() const noexcept { return count_; }
    const MotionRow& row(int i) const noexcept { return rows_[static_cast<std::size_t>(i)]; }
    double lambda(int i) const noexcept { return lambdas_[static_cast<std::size_t>(i)]; }

    /// False if the row depends on those that are there, or these are N.
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

    std::array<MotionRow, N> rows_;
    std::array<double, N> lambdas_{};
    using Square = Eigen::Matrix<double, N, N>;
    Square Q_ = Square::Zero(), R_ = Square::Zero();
    int count_ = 0;
};
using ActiveSet = ActiveSetOf<6>;

inline constexpr int kMostUnknowns = 24;  // of four bodies
extern template class ActiveSetOf<6>;
extern template class ActiveSetOf<kMostUnknowns>;

}  // namespace passung::motion
