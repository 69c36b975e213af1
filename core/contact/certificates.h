#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/field/distance_field.h"

namespace passung::contact {

/// What earlier looks of a shell in a field proved of spheres around its points, the nodes of its tree or the stretches
/// of its edges, carried on from pose to pose. (Own.)
///   A look at the pose X_r (of the shell in the field) proves  φ ≥ m  of the points in a sphere: by the bound at its
/// centre, or, of a leaf that was read, by those of all its points (DistanceField::lowerBounds). φ is 1-Lipschitz, so
/// that at X
///   φ(X p) ≥ m - |X p - X_r p|,   |X p - X_r p| ≤ |ΔR c + Δx| + |ΔR|₂ R,
/// c and R the sphere's, ΔR = R_X - R_r, Δx the same of the origins. |ΔR|₂ = 2 sin(θ/2) = |ΔR|_F / √2.
/// What is proven to be at `limit` or above has nothing for a look that asks for less, and is not looked at.
///   A traversal prunes by the true φ in any case (queryContacts); but what it reads may be below `limit` where the
/// true φ is above, by what the field errs. So that the same is found with certificates and without, as much is left
/// between: the accuracy that the field was built to, and a tenth of depth.
/// Besides, of fields of which is known how their values change from place to place (DistanceField::change): what was
/// read of a leaf's points, the least as v, says what is read of them later, and needs no accuracy and no proof,
///   v' ≥ leastAround(v, |X p - X_r p|).
/// Limit cases: the same pose → m holds as it is. More than kPoses looks ago → nothing is known; a certificate that is
/// asked for is renewed before. A field with holes, or no memory → nothing is ever proven.
class Certificates {
public:
    Certificates() = default;  // no memory
    /// `accuracy`: of the field near the surface [m].
    Certificates(std::size_t spheres, double accuracy, const field::ReadChange& change = {})
        : spheres_(spheres), change_(change), accuracy_(accuracy) {}

    /// Of another shell and field of no more spheres from now on: nothing is known. rt-safe, as all below.
    void restart(double accuracy, const field::ReadChange& change = {}) noexcept;
    /// A look begins.
    void begin(const Pose& X_FS) noexcept;
    /// True if no point in sphere `i`, which is around `centre`, is read below `limit`.
    bool above(std::uint32_t i, const Vec3& centre, double radius, double limit) noexcept;
    /// No point in sphere `i` has a true φ below `least`.
    void note(std::uint32_t i, double least) noexcept;

    /// Whether it pays to prove a bound of what was read in sphere `i`, the least as `least`, where `limit` was asked
    /// for: not where it holds what was looked for or moves by more from look to look, and seldom where the field could
    /// prove nothing.
    bool paysToProve(std::uint32_t i, const Vec3& centre, double radius, double least, double limit) noexcept;
    /// As note(), from what paid to be proven.
    void noteProof(std::uint32_t i, double least, double limit) noexcept;

    /// The least that was read of the points in sphere `i` in this look.
    void noteRead(std::uint32_t i, double least) noexcept;
    /// True if for that reason none of them is read below `low` now, and the least not above `high`.
    bool readsWithin(std::uint32_t i, const Vec3& centre, double radius, double low, double high) noexcept;
    /// paysToProve() is false of what was read below this.
    double provableFrom(double limit) const noexcept;

    /// The point of the shell that was deepest or nearest in the last look that found one: where the next one is told
    /// by φ at it how deep it will get, it passes over what is not that deep before it gets there.
    std::uint32_t deepest = kNone;
    static constexpr std::uint32_t kNone = ~0u;

    static constexpr std::uint32_t kPoses = 64;
    static constexpr std::uint32_t kPatience = 8;  // looks after which a proof that failed is tried again

private:
    struct Sphere {
        double proven = 0.0;
        std::uint32_t look = 0;   // 0: never
        std::uint32_t tried = 0;  // last look of a proof that failed
        std::uint32_t read_look = 0;
        double read = 0.0;
    };
    struct View {
        Mat3 R = Mat3::Zero();
        Vec3 p = Vec3::Zero();
    };
    /// From the pose of a look to that of now.
    struct Change {
        View by;
        double turn = 0.0;
        std::uint32_t until = 0;  // the look that it was computed for
    };
    const Change& changeSince(std::uint32_t look) noexcept;
    double waySince(std::uint32_t look, const Vec3& centre, double radius) noexcept;

    std::vector<Sphere> spheres_;
    std::array<View, kPoses> views_;
    std::array<Change, kPoses> changes_;
    field::ReadChange change_;
    double accuracy_ = 0.0;
    std::uint32_t look_ = 0;
};

/// Of a shell's points and of its edges.
struct ShellCertificates {
    Certificates nodes, stretches;
};

}  // namespace passung::contact
