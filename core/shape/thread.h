#pragma once

#include <array>
#include <numbers>

#include "core/shape/shape.h"

namespace passung::shape {

/// A thread: right-handed, one start, straight flanks, crest and root flat. Frame: axis z. In the half plane at the
/// angle φ its profile is r(ζ), ζ = z - lead φ, of period `pitch`:
///   |ζ| <= crest: outer;  |ζ| >= root: inner;  straight flanks between.
/// As in ISO 68-1 ridge and groove are equally wide at 3/5 of the height below the crest. There flanks are 60° apart
/// and 5/8 · √3/2 · pitch high: crest = pitch/16, root = 3/8 pitch.
/// Of a bolt that is the material's end, of a nut the hole's. So a bolt fills a nut of its diameter; with clearances
/// that add up to c it has the play c at crests and roots, c/2 between flanks.
struct ThreadForm {
    double pitch, outer, inner;  // [m]
    double run;                  // of a flank along the axis per its height: the tangent of half its angle
    double wider = 0.0;          // than without clearance: a ridge, on either side [m]

    /// A straight line of the profile: r = at_zero + slope ζ.
    struct Line {
        double begin, end;  // of ζ [m]
        double at_zero, slope;
    };

    double lead() const { return pitch / (2.0 * std::numbers::pi); }  // [m/rad]
    double crest() const { return 0.25 * pitch + wider - 0.6 * (outer - inner) * run; }
    double root() const { return 0.25 * pitch + wider + 0.4 * (outer - inner) * run; }
    /// Half of the bolt's ridge at r, between inner and outer.
    double halfRidge(double r) const { return crest() + (outer - r) * run; }
    /// Where ridge and groove are equally wide, on a flank or on its straight line beyond [m].
    double evenRadius() const { return outer - (0.25 * pitch - crest()) / run; }
    /// The most that flanks may overlap before their edges touch (thread_solid.h) [m].
    double mostBetweenEdges() const;
    /// r(ζ) of any ζ.
    double radiusAt(double zeta) const;
    /// A period from the middle ridge's lower root on: flank, crest, flank, root.
    std::array<Line, 4> lines() const;
};

ThreadForm threadOf(const ThreadBolt& bolt);
ThreadForm threadOf(const ThreadNut& nut);

}  // namespace passung::shape
