#pragma once

#include <array>
#include <numbers>

#include "core/shape/shape.h"

namespace passung::shape {

/// A thread by ISO 68-1: right-handed, one start, flanks 60° apart, crest and root flat. Frame: axis z. In the half
/// plane at the angle φ its profile is r(ζ), ζ = z - lead φ, of period `pitch`:
///   |ζ| <= pitch/16: outer;  |ζ| >= 3/8 pitch: inner;  straight flanks between,  outer - inner = 5/8 · √3/2 · pitch.
/// Of a bolt that is the material's end, of a nut the hole's. So a bolt fills a nut of its diameter; with clearances
/// that add up to c it has the play c at crests and roots, c/2 between flanks.
struct ThreadForm {
    double pitch, outer, inner;  // [m]

    /// A straight line of the profile: r = at_zero + slope ζ.
    struct Line {
        double begin, end;  // of ζ [m]
        double at_zero, slope;
    };

    double lead() const { return pitch / (2.0 * std::numbers::pi); }  // [m/rad]
    /// Half of the bolt's ridge at r, between inner and outer.
    double halfRidge(double r) const { return pitch / 16.0 + (outer - r) / std::numbers::sqrt3; }
    /// r(ζ) of any ζ.
    double radiusAt(double zeta) const;
    /// A period from the middle ridge's lower root on: flank, crest, flank, root.
    std::array<Line, 4> lines() const;
};

ThreadForm threadOf(double diameter, double pitch);
inline ThreadForm threadOf(const ThreadBolt& bolt) {
    return threadOf(bolt.nominal_diameter - 2.0 * bolt.clearance, bolt.pitch);
}
inline ThreadForm threadOf(const ThreadNut& nut) {
    return threadOf(nut.nominal_diameter + 2.0 * nut.clearance, nut.pitch);
}

}  // namespace passung::shape
