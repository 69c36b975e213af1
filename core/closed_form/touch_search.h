#pragma once

#include <cstdint>

#include "core/closed_form/fixed_list.h"
#include "core/closed_form/solid.h"

namespace passung::closed_form {

/// A place where a line of one part is nearest to, or deepest in, a lump of the other; frame of the lump.
struct Touch {
    enum class Kind {
        Smooth,  // the least distance of one face
        Kink,    // two faces cross on the line: edge on edge
        Fixed,   // a point of the line that is looked at wherever the line lies: its ends, eight of a circle
    };

    Kind kind = Kind::Smooth;
    double t = 0.0;                   // on the line
    double gap = 0.0;                 // [m], below 0: overlap
    std::uint8_t a = 0;               // the face, among the lump's
    std::uint8_t b = kNone;           // of a kink: the other, rising where `a` falls
    double share = 1.0;               // of `a`, of a kink
    double cosine = 0.0, sine = 0.0;  // of t on a circle; 0 and 0: nobody has computed them
    std::uint8_t fixed = kNone;       // which fixedPlace() of a circle it is

    static constexpr std::uint8_t kNone = 255;

    LinePlace on(const Curve& line) const noexcept {
        const bool known = line.kind == Curve::Kind::Circle && (cosine != 0.0 || sine != 0.0);
        return known ? LinePlace{t, cosine, sine} : placeAt(line, t);
    }
};

/// Touches of one line.
using Touches = FixedList<Touch, 40>;

inline constexpr double kBesideKink = 0.3;  // of a line's parameter: a fixed point there has one face's normal alone
inline constexpr double kSameTouch = 2e-3;  // of a line's parameter

/// All local minima of the lump's function along an edge whose gap is at most `reach`, and the fixed points. `edge` in
/// the frame of the lump. The function is the largest of the faces', because the material is convex at an edge: outside
/// one face is enough. A minimum is bracketed between samples and found by false position, anew at every call: where
/// one splits into two, both are found. rt-safe.
/// Returns a bound that the lump's function is nowhere below on the edge [m]. `closer`: a second one, which takes
/// longer and is mostly higher; where it would not be it is left as it is.
double searchEdge(const Curve& edge, const Lump& lump, double reach, Touches& touches,
                  double* closer = nullptr) noexcept;

/// The places where the material around a core is nearest to single faces, with the nearest point on the face itself.
/// Returns a bound as searchEdge() does, of the distance less the thickness. rt-safe.
double searchCore(const Curve& core, const Lump& lump, double reach, Touches& touches) noexcept;
/// Could it find any, wherever the core lies?
bool canTouch(const Curve& core, const Lump& lump) noexcept;

}  // namespace passung::closed_form
