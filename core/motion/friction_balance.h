#pragma once

#include "core/motion/friction_patch.h"

namespace passung::motion {

/// The motion that contacts with dry friction leave to a body: the solution of friction.h, whose symbols these are.
///
/// Derivation. Let σ_p ≥ 0 be given for each patch. The problem
///   min ½|u - w|²   s.t.   a_i · u ≥ b_i + μ (|B_p u| - σ_p)   for each contact i of each patch p
/// is convex. Its multipliers λ_i press with Λ_p = Σ λ_i, and rub with x_p, |x_p| ≤ μ Λ_p, = -μ Λ_p s/|s| where
/// s = B_p u is not zero. Where σ_p = |s_p| that is the law of friction, with normals that give nothing along with slip
/// (De Saxcé and Feng 1998); the fixed point σ → |s| exists whenever standing still is allowed, and is reached in a few
/// turns (Cadoux 2009; Acary, Cadoux, Lemaréchal and Malick 2011).
///
/// For fixed σ the cone is made of its tangents, found as they are needed: |s| ≥ d · s for every unit d, so that
///   (a_i - μ B_pᵀ d) · u ≥ b_i - μ σ_p
/// is a row like any other (active_set.h), and d = s/|s| at a motion that violates the cone the one that cuts it off
/// most. Each row taken up raises the dual objective, no row is needed twice, what rows leave out is quadratic in the
/// angle between two directions. Rest is the tip of the cone, where tangents meet: no slip is left.
///
/// Turns of σ are mixed with the turn before (Anderson 1965), the cuts of a turn found only as well as σ is known, and
/// contacts that do not hold looked at when those that do are content: in the first turn all, then only those that some
/// motion has violated (they are watched), and once σ has settled among these all again. Where overlap is to be removed
/// and the rows have no common solution it is only kept from growing, as in constrained_motion.h.
/// Limit cases: u = 0 is allowed, hence |u| ≤ |w|: nothing is thrown out of a groove. A groove that locks itself: at
/// σ = 0 already u = 0. σ that does not settle in kFrictionSweeps turns: σ = 0, which obeys contacts and cone but lets
/// what slips rise by up to μ |s|. Bounded by kMostRounds sets of cuts and kMostSteps rows taken up. rt-safe.
class FrictionBalance {
public:
    /// `plain`: the motion without friction.
    FrictionBalance(const Motion& wanted, const Surroundings& around, std::span<const Friction> friction,
                    const ConstrainedMotion& plain, const FrictionPatches& before) noexcept;

    FrictionMotion find() noexcept;

private:
    struct Patch {
        FrictionPatch is;
        Eigen::Matrix<double, 3, 6> B = Eigen::Matrix<double, 3, 6>::Zero();
        Vec3 slip = Vec3::Zero();
        double given = 0.0;          // σ [m]
        double off = 0.0;            // |s| - σ of the turn before [m]
        double slip_before = 0.0;    // |s| then [m]
        double pressure = 0.0;       // Λ of now [m]
        Vec3 moment = Vec3::Zero();  // Σ λ_i P_i
    };
    /// A tangent of the cone of one contact.
    struct Cut {
        std::uint32_t contact;
        int patch;
        Vec3 direction;  // d, or zero
    };
    static constexpr int kMostPatches = 12, kMostCuts = 192;
    static constexpr std::size_t kMostWatched = 192;

    double coefficientOf(const Patch& patch) const noexcept;
    int patchFor(const contact::ContactPoint& contact) noexcept;
    double least(const contact::ContactPoint& contact) const noexcept;
    void place(Patch& patch) const noexcept;
    void goOn(Patch& patch) const noexcept;
    void addCut(std::uint32_t contact, int patch, const Vec3& direction) noexcept;
    void buildRow(int cut) noexcept;
    double violationOf(const contact::ContactPoint& contact, const Patch& patch) const noexcept;
    int mostViolated() const noexcept;
    bool cutActive(double enough) noexcept;
    void makeRoom() noexcept;
    void noteSlips() noexcept;
    bool cutAmong(bool all, double enough) noexcept;
    bool cutOff(double enough, bool all) noexcept;
    void watch(const Cut& contact) noexcept;
    bool solveCuts(double enough, bool all) noexcept;
    void restart() noexcept;
    void measure() noexcept;
    double turn(bool centres) noexcept;
    void tell(FrictionMotion& result) const noexcept;

    const Motion& wanted_;
    const Surroundings& around_;
    const std::span<const Friction> friction_;
    const FrictionPatches& before_;
    const double size_, tolerance_, fine_;
    bool relaxed_ = false, converged_ = true;
    std::array<Patch, kMostPatches> patches_;
    int patch_count_ = 0;
    std::array<Cut, kMostCuts> cuts_;
    std::array<MotionRow, kMostCuts> rows_;
    int cut_count_ = 0;
    std::array<Cut, kMostWatched> watched_;  // whatever their directions
    std::size_t watched_count_ = 0;
    ActiveSet active_;
    Motion u_ = Motion::Zero();
    double last_change_ = 0.0;
    int iterations_ = 0, rounds_ = 0;
};

}  // namespace passung::motion
