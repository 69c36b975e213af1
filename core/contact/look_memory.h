#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/field/cell_memory.h"
#include "core/shell/sphere_tree.h"

namespace passung::contact {

/// What the looks so far found out about one shell in one field; queryContacts uses it and adds to it. Sized once.
///
/// Certificates. A look leaves at a place of the shell (a node's centre, or all points of a leaf) a lower bound of the
/// true φ there, with the pose. A signed distance is 1-Lipschitz, so that at another pose of the shell the bound is
/// less by no more than the place has moved between the two poses,
///   |c' - c| + 2 sin(θ/2) r,   c the centre, r the radius of what the bound is for, θ the angle between the poses.
/// What lies above all that a query looks for is left alone. The bound of a leaf is that of its points, not of their
/// sphere: of a long leaf beside a wall it prunes where the sphere cannot.
class LookMemory {
public:
    explicit LookMemory(const shell::SphereTree& shell)
        : cells(shell.points().size()), centres_(shell.nodes().size()), leaves_(shell.nodes().size()) {}
    LookMemory() = default;

    /// Lower bounds at a pose of the shell [m]; -infinity: nothing known.
    double atCentre(std::uint32_t node, const Vec3& centre_F) const noexcept {
        return centres_[node].bound - sinceCentre(node, centre_F);
    }
    double ofLeaf(std::uint32_t node, const Vec3& centre_F, const Quat& q_FS, double radius) const noexcept {
        return leaves_[node].bound - sinceLeaf(node, centre_F, q_FS, radius);
    }
    /// How far a centre has moved since its bound was found [m]; without one 1e300.
    double sinceCentre(std::uint32_t node, const Vec3& centre_F) const noexcept {
        const Certificate& known = centres_[node];
        return known.bound > kNothing ? (centre_F - known.centre_F).norm() : 1e300;
    }
    /// What no point of a leaf has moved more than since its bound was found [m].
    double sinceLeaf(std::uint32_t node, const Vec3& centre_F, const Quat& q_FS, double radius) const noexcept {
        const Certificate& known = leaves_[node];
        if (!(known.bound > kNothing)) return 1e300;
        const double half_sine = (q_FS.conjugate() * known.q_FS).vec().norm();
        return (centre_F - known.centre_F).norm() + 2.0 * kMore * half_sine * radius;
    }

    void noteCentre(std::uint32_t node, double bound, const Vec3& centre_F) noexcept {
        centres_[node] = {bound, centre_F, Quat::Identity()};
    }
    void noteLeaf(std::uint32_t node, double bound, const Vec3& centre_F, const Quat& q_FS) noexcept {
        leaves_[node] = {bound, centre_F, q_FS};
    }

    field::CellMemory cells;  // of the shell's points

private:
    static constexpr double kNothing = -1e300;
    static constexpr double kMore = 1.0 + 1e-9;  // quaternions are of unit length but for rounding
    struct Certificate {
        double bound = kNothing;
        Vec3 centre_F = Vec3::Zero();
        Quat q_FS = Quat::Identity();
    };
    std::vector<Certificate> centres_, leaves_;
};

}  // namespace passung::contact
