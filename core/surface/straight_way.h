#pragma once

#include "core/surface/hull_distance.h"

namespace passung::surface {

/// A part that goes straight and turns about one axis, both evenly, seen from an obstacle.
struct StraightWay {
    Placement from, to;
    Vec3 turn = Vec3::Zero();  // from one to the other [rad]

    StraightWay(const Placement& begin, const Placement& end) noexcept;
    Placement at(double share) const noexcept;
    /// The same, of the obstacle as the part sees it: it ends at the same places and may go another way.
    StraightWay mirrored() const noexcept;
};

/// True if it is proven that the held hull meets the obstacle's nowhere on the way. Of pieces, the longest that one
/// plane or one that turns evenly sets apart, none shorter than a sixteenth: in each of them a point goes along the
/// chord, and beside it by no more than R θ²/8. `n`: a direction to begin with. `looks` grows by those that it took.
/// rt-safe, bounded.
bool keepsApart(const HullPair& pair, const StraightWay& way, const Vec3& n_begin, const Vec3& n_end,
                int& looks) noexcept;

}  // namespace passung::surface
