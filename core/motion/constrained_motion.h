#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "core/contact/contact_query.h"
#include "core/motion/active_set.h"
#include "core/motion/metric.h"

namespace passung::motion {

/// A piece of where two surfaces lie on each other.
struct TouchingPiece {
    Vec3 centre = Vec3::Zero();  // world [m]
    Vec3 normal = Vec3::Zero();  // unit, out of the obstacle
    double area = 0.0;           // [m²]
    std::uint32_t obstacle = 0;
};

/// What a body's motion meets.
struct Surroundings {
    const contact::ContactManifold& contacts;
    PlacedMetric metric;                         // of the body's motions
    double keep_out;                             // the φ that a contact must keep, slightly negative [m]
    double sunk_out = keep_out;                  // and that one keeps which is deeper already, ≤ keep_out
    std::span<const TouchingPiece> pieces = {};  // where contacts are corners of what touches; else they have its areas
    const MotionMatrix* unbent = nullptr;        // T; none: 1

    /// What is solved for is u, the body moves by Tᵀ u. An energy ½ vᵀ B v - wᵀ v of motions v, B = L Lᵀ, is
    /// ½|u - T w|² up to a constant with T = L⁻¹: as that of a spring, only that rows become T a.
    Motion unbentRow(const Motion& a) const noexcept { return unbent == nullptr ? a : Motion(*unbent * a); }
    Motion motionOf(const Motion& u) const noexcept { return unbent == nullptr ? u : Motion(unbent->transpose() * u); }
    /// What a contact at `point` with a normal does to u.
    Motion rowOf(const Vec3& point, const Vec3& normal) const noexcept {
        return unbentRow(metric.rowOf(point, normal));
    }
    /// How far points are carried by `u`.
    struct Carried {
        Vec3 origin, turn;  // of the world's origin [m], and about it [rad]
        Vec3 of(const Vec3& p_WP) const noexcept { return origin + turn.cross(p_WP); }
    };
    Carried carriedBy(const Motion& u) const noexcept {
        const Motion v = motionOf(u);
        const Vec3 turn = metric.turnOf(v);
        return {v.head<3>() - turn.cross(metric.centre), turn};
    }
    /// How far the point at `p_WP` is carried by `u` [m].
    Vec3 wayOf(const Vec3& p_WP, const Motion& u) const noexcept {
        const Motion v = motionOf(u);
        return v.head<3>() + metric.turnOf(v).cross(p_WP - metric.centre);
    }
};

/// A contact that holds a motion.
struct ActiveContact {
    std::uint32_t contact = 0;  // its place in the manifold
    double push = 0.0;          // of it along its normal, as a motion [m]: times the coupling's stiffness, its force
};

struct ConstrainedMotion {
    Motion u = Motion::Zero();
    std::array<ActiveContact, 6> active_contacts{};  // the first `active`
    int active = 0;                                  // contacts that hold the motion, at most six
    int iterations = 0;                              // contacts taken up or let go
    bool relaxed = false;   // the overlap could not be removed within this motion: it is only kept from growing
    bool converged = true;  // false: kMaxIterations reached; contacts may be violated
};

inline constexpr int kMaxIterations = 200;
inline constexpr double kFarther = 4.0;           // per overlap to be removed: a motion bent by more went far away
inline constexpr double kMotionTolerance = 1e-9;  // [m], of a constraint; 2e-7 of a wanted motion above 5 mm

/// The motion nearest to `wanted` that obeys all contacts, by Gauss's principle of least constraint:
///   min ½|u - w|²   s.t.   a_i · u ≥ b_i,   a_i = (g_i, S⁻¹ (r_i × g_i)),  r_i = P_i - c,  b_i = keep_out - φ_i
/// g_i the gradient of φ, c and S those of the metric; where φ_i < keep_out, b_i = sunk_out - φ_i: the deepest come out
/// first.
///
/// Source: Goldfarb and Idnani (1983), dual active set, for a unit Hessian. With N the active rows, λ their multipliers
/// and u = w + N λ, λ ≥ 0, the most violated row a is taken up along
///   r = N⁺ a,  z = a - N r:   u += t z,  λ -= t r,  λ_a += t,   t = min((b - a·u)/|z|², min over r_j > 0 of λ_j/r_j);
/// where the second is smaller, row j is let go and the step repeated. Active rows are independent, hence at most six;
/// N is kept as Q R. Exact when it ends, and it ends because the dual objective grows with each row taken up.
///
/// Many contacts: rows are made of those only that some u on the way has violated. All contacts are looked at when no
/// row is violated any more; of those that are, the worst of each of 64 bins goes into the rows, the bins by the signs
/// of a's six numbers: the extreme points of what is violated, seen all around. At most kMostRows; when they are full
/// those that do not hold are forgotten. At the end no contact is violated, so that nothing is lost against rows of
/// all: a motion nearest under some constraints, that obeys the others too, is the nearest under all.
///
/// Warm start: with rows N that held before, λ = (NᵀN)⁻¹ (b - Nᵀw); a row with λ < 0 pulls and is let go, the worst
/// first, until none does. Then (u, λ) is what the method itself would hold if these were the only rows, and it goes on
/// from there: the same motion in the end, found in as few steps as contacts changed.
///
/// Rows that ask for more than standing still (b_i > 0: overlap to be removed) may have no common solution, or only one
/// far away (a part pressed between two walls): |u - w| > |w| + kFarther max b_i, as in a wedge whose walls are nearer
/// than 29 degrees to each other. Then b_i becomes min(b_i, 0), `relaxed`: u = 0 obeys that always, and |u - w| ≤ |w|.
/// A sphere that stands for points not looked at (ContactPoint::radius > 0) never asks for more than 0. Contacts whose
/// field is flatter than kLeastGradient (a medial axis) say nothing about direction and are left out. Limit cases: no
/// contact violated → wanted. One → the projection onto its plane. rt-safe, bounded.
class MotionSolver {
public:
    /// `likely`: places in the manifold of at most six contacts that held a motion like those to come.
    explicit MotionSolver(const Surroundings& around, std::span<const std::uint32_t> likely = {}) noexcept;

    ConstrainedMotion solve(const Motion& wanted) noexcept;

    static constexpr int kMostRows = 200;

private:
    double wantedOf(const contact::ContactPoint& contact) const noexcept;
    double least(const contact::ContactPoint& contact) const noexcept;
    double boundOf(const MotionRow& row) const noexcept;
    void addRow(const contact::ContactPoint& contact) noexcept;
    const MotionRow* mostViolated(const Motion& u) const noexcept;
    bool meetsMore(const Motion& u) noexcept;
    bool attempt(const Motion& wanted, ConstrainedMotion& result) noexcept;

    const Surroundings& around_;
    std::array<MotionRow, kMostRows> rows_;
    int count_ = 0;
    std::array<MotionRow, 6> last_active_;  // the last motion
    int last_active_count_ = 0;
    double tolerance_ = kMotionTolerance;
    bool relaxed_ = false;
};

/// One motion: MotionSolver::solve.
ConstrainedMotion constrainMotion(const Motion& wanted, const Surroundings& around,
                                  std::span<const std::uint32_t> likely = {}) noexcept;

inline constexpr double kLeastGradient = 0.1;

/// Which of 64 bins a row falls into, by the signs of its six numbers; `lever`: r × gradient. rt-safe.
std::size_t binOf(const Vec3& gradient, const Vec3& lever) noexcept;
inline constexpr std::size_t kBins = 64;

}  // namespace passung::motion
