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

/// How far a point of the hull goes beside its chord on the way, at most [m].
double riseOf(const HullPair& pair, const StraightWay& way) noexcept;

/// True if it is proven that the held hull meets the obstacle's nowhere on the way: by a plane that turns evenly from
/// `n0` to `n1`, which sets them apart by no less than `least` at both ends. rt-safe.
bool setsApart(const HullPair& pair, const StraightWay& way, const Vec3& n0, const Vec3& n1, double least) noexcept;

/// The same by pieces, the longest that a plane sets apart, fixed or turning, none shorter than a sixteenth; at the
/// ends of the way those are `n_begin` and `n_end`. `looks` grows by those that it took. rt-safe, bounded.
bool keepsApart(const HullPair& pair, const StraightWay& way, const Vec3& n_begin, const Vec3& n_end,
                int& looks) noexcept;

}  // namespace passung::surface
