#pragma once

#include <array>
#include <span>
#include <utility>

#include "core/motion/constrained_motion.h"

namespace passung::motion {

/// Coulomb's coefficients of dry friction of two surfaces; both 0: none.
struct Friction {
    double at_rest = 0.0;  // μ_s ≥ μ_d
    double sliding = 0.0;  // μ_d ≥ 0
};

inline constexpr double kSameWay = 0.985;  // cosine of 10 degrees: contacts that face so much alike rub as one

/// Contacts with one obstacle that face one way and rub as one.
struct FrictionPatch {
    Vec3 normal = Vec3::Zero();   // unit, out of the obstacle
    Vec3 centre = Vec3::Zero();   // of pressure; world
    double radius = 0.0;          // r_e, the effective one of its torsion [m]
    double pressure = 0.0;        // what the contacts push with, as a motion [m]: times the coupling's stiffness [N]
    Vec3 impulse = Vec3::Zero();  // x below [m]
    std::uint32_t obstacle = 0;
    double slip = 0.0;  // |s| below [m]
    bool slides = false;
};

/// Two unit vectors along the plane across `n`. rt-safe.
std::pair<Vec3, Vec3> tangentsOf(const Vec3& n) noexcept;

/// `impulse` along the surface, as a vector of the world [m]; its third part, the torsion, apart. rt-safe.
Vec3 impulseAlong(const FrictionPatch& patch) noexcept;

/// Patches of one motion. At most six, since no more contacts hold it.
struct FrictionPatches {
    std::array<FrictionPatch, 6> patch;
    int count = 0;
    Motion motion = Motion::Zero();  // what the body did
};

struct FrictionMotion {
    ConstrainedMotion motion;
    FrictionPatches patches;
    int sweeps = 0;
    double change = 0.0;    // of slip in the last sweep, per wanted motion
    bool converged = true;  // false: contacts and cone are obeyed, but what slips rises
};

inline constexpr int kFrictionSweeps = 30;
inline constexpr int kMostSteps = 1000;  // rows that these take up in all

/// The motion that the contacts leave to a body that is drawn along `wanted` by a spring, with friction.
///
/// constrainMotion() finds u = w + Σ λ_i a_i: the spring K(w - u) is held by contact forces K λ_i. With friction
///   u = w + Σ λ_i a_i + Σ_p B_pᵀ x_p,
///   B_p = (t₁, (r × t₁)/ρ),  (t₂, (r × t₂)/ρ),  (0, r_e n/ρ)      two tangents and the torsion of patch p at r
///   |x_p| ≤ μ Λ_p,  Λ_p = Σ λ_i over the patch;   x_p = -μ Λ_p s/|s|  where the slip s = B_p u is not zero.
/// The bound on (x₁, x₂, x₃) is the ellipsoidal limit surface of a patch (Howe and Cutkosky 1996): full friction either
/// along or as torsion, T ≤ μ r_e F, never both at once. μ is `at_rest` for a patch that did not slide before and
/// `sliding` for one that does. A patch that is new slides if what slid before would have slid there: as contacts of a
/// thread come and go along its flanks.
///
/// r_e is the mean distance from the centre of pressure over the patch, under the pressure that varies linearly over it
/// and has that centre: 2/3 R for a disc pressed evenly, half the distance for two equal feet. The patch is the
/// contacts by their areas, or the pieces of Surroundings; where it has neither, the contacts as feet.
///
/// Solution: friction_balance.h. Contacts and cone are obeyed always, up to the tolerance of constrained_motion.h and
/// up to μ `change` |w|; slip is against friction where `converged`.
/// Limit cases: μ = 0 → constrainMotion. All patches at rest → u is zero along them, exactly: nothing creeps. One plane
/// → |x| = μ λ in slip, along -s.
/// `friction`: of each obstacle. `before`: patches of the motion before, which tell what was sliding. rt-safe, bounded.
FrictionMotion constrainWithFriction(const Motion& wanted, const Surroundings& around,
                                     std::span<const Friction> friction, const FrictionPatches& before,
                                     std::span<const std::uint32_t> likely = {}) noexcept;

/// The same, from a motion on that is likely: where it goes, and what holds it.
FrictionMotion balanceFriction(const Motion& wanted, const Surroundings& around, std::span<const Friction> friction,
                               const FrictionPatches& before, const ConstrainedMotion& likely) noexcept;

}  // namespace passung::motion
