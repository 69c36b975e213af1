#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/types.h"
#include "core/shape/shape.h"

namespace passung::truth {

/// A condition that a motion u = (Δx, ρ Δφ) of the held part has to obey: along · u ≥ -gap, lengths [m].
struct FreedomRow {
    Eigen::Matrix<double, 6, 1> along;
    double gap = 0.0;
};

/// Where a held part is kept apart from its obstacles, in closed form. Every obstacle is a union of convex pieces, for
/// which
///   gap = max over unit n of (least n · a of the held part's points a) - (largest n · b of the piece's points b),
/// is the distance of two convex bodies, negative: the depth by which they overlap. Its n is the contact's normal: of a
/// face where one touches, orthogonal to both edges where edges cross. A motion changes the gap by n · (Δx + Δφ × r), r
/// from the held part's origin to the place of contact. Neither lines against faces nor points are asked, as
/// core/closed_form does: what the two have in common is the shapes' dimensions.
class Separation {
public:
    virtual ~Separation() = default;

    /// A row for each piece that is nearer than `reach`, `rho` in m; in world axes. False: not this pair's case.
    virtual bool rowsAt(const Pose& X_WG, double rho, double reach, std::vector<FreedomRow>& rows) const = 0;
};

/// What stands in the world.
using PlacedShape = std::pair<shape::Shape, Pose>;

/// A ball among balls, boxes, bars and pegs, by the exact signed distance of its centre; null for other pairs.
std::unique_ptr<Separation> separationOfBall(const shape::Shape& held, std::span<const PlacedShape> obstacles);

/// A round peg and a plate with a round bore. The plate's material about the bore is the union, over all angles φ, of
/// what lies beyond the tangent planes of wall and mouth at φ: prisms along the tangent, so that each gap is one of two
/// plane figures, the prism's corner and the peg's shadow. Least gaps over φ are found to the last digits, and angles
/// between stand beside them. Not the case: the peg's tip reaches the plate's outer sides. Null for other pairs.
std::unique_ptr<Separation> separationOfPeg(const shape::Shape& held, std::span<const PlacedShape> obstacles);

/// Boxes, square pegs and plates with a square pocket, which are unions of convex polyhedra: the best axis among the
/// normals of both parts' faces and the products of their edges. Null for other pairs.
std::unique_ptr<Separation> separationOfPolyhedra(const shape::Shape& held, std::span<const PlacedShape> obstacles);

/// The one of the above that knows the pair; null if none does.
std::unique_ptr<Separation> separationOf(const shape::Shape& held, std::span<const PlacedShape> obstacles);

}  // namespace passung::truth
