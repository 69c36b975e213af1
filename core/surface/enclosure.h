#pragma once

#include <cstddef>

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// Finds out whether something of one part lies wholly within the other, where no triangles tell, and how it comes out.
///   Each piece of one surface that meets none of a body of the other is inside or outside as a whole: by the winding
/// number of the body around one of its corners (Jacobson 2013), Σ Ω_i / 4π > ½ of the faces' solid angles. So a sheet
/// or a surface that is open by half encloses nothing.
/// The way out: over the nearest points q of all faces, with d = (q - w)/|q - w| of the corner w, the least of
///   |q - w| + max_x d · (w - x),  x of the piece's box,
/// which takes the piece beyond the plane through q across d; along the hand where its way leads out. For a convex body
/// and a box along its axes that is the shortest one; for others what is at its end has to be asked again.
/// Limit cases: corner beyond the body's box → outside, for one comparison.
class EnclosureSearch {
public:
    /// The trees outlive this.
    EnclosureSearch(const ClusterTree& held, const ClusterTree& obstacles) : held_(&held), obstacles_(&obstacles) {}

    /// Begins with the first pair.
    void restart() noexcept;

    /// Goes on from where it ended. False: the budget ended. `X`: where the held part lies, the same since restart();
    /// `hand`: how far it would go to the hand, world; that of the beginning counts. rt-safe, at most one face beyond
    /// the budget.
    bool advance(const Placement& X, const Vec3& hand, int& work, int budget) noexcept;

    /// Of what advance() has found.
    bool encloses() const noexcept { return found_; }
    /// How the held part comes out, world [m].
    const Vec3& wayOut() const noexcept { return way_out_; }

    static constexpr int kWorkOfFace = 6;

private:
    struct Pair;
    Pair pairOf(std::size_t i, const Placement& X) const noexcept;
    void lookAt(const Pair& pair, const Cluster& face) noexcept;

    const ClusterTree* held_;
    const ClusterTree* obstacles_;
    std::size_t pair_ = 0, face_ = 0;
    bool found_ = false;
    Vec3 way_out_ = Vec3::Zero(), hand_ = Vec3::Zero();
    // Of the pair at hand.
    double angle_ = 0.0;                // Σ Ω_i [sr]
    Vec3 nearest_ = Vec3::Zero();       // d times the way by it, in the body's frame [m]
    double shortest_ = 0.0, hits_ = 0;  // its length; the first face on the hand's way [m]
};

}  // namespace passung::surface
