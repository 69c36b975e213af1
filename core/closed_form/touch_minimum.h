#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/closed_form/touch_search.h"

// What searches for touches share. A walk is a lump's function along a line: points of it, of which it tells values and
// slopes of each face and the highest face, and how near to a minimum is enough.

namespace passung::closed_form {

inline constexpr int kSteps = 60;         // to close a bracket
inline constexpr double kClosed = 1e-10;  // of a line's parameter
inline constexpr double kCrossed = 1e-8;  // [m]: faces that are farther apart do not cross there, one of them jumps

inline std::uint8_t placeOf(const Lump& lump, const Face& face) noexcept {
    return static_cast<std::uint8_t>(&face - lump.faces.data());
}

template <class Point>
Touch touchAt(Touch::Kind kind, const Point& at, double gap, std::uint8_t face) noexcept {
    return {.kind = kind, .t = at.t, .gap = gap, .a = face, .cosine = at.cosine, .sine = at.sine};
}

template <class Point>
Touch kinkAt(const Point& at, double gap, std::uint8_t a, std::uint8_t b, double share) noexcept {
    Touch kink = touchAt(Touch::Kind::Kink, at, gap, a);
    kink.b = b;
    kink.share = share;
    return kink;
}

/// A place on the line, with the highest face there.
template <class Walk>
struct SampleOn {
    double value = 0.0, slope = 0.0;
    const Face* face = nullptr;
    typename Walk::Point at;
};

template <class Walk>
SampleOn<Walk> sampleAt(const Walk& walk, double t) noexcept {
    SampleOn<Walk> sample;
    sample.at = walk.at(t);
    sample.face = walk.highest(sample.at, sample.value);
    sample.slope = walk.slope(*sample.face, sample.at);
    return sample;
}

/// The zero of a function between two places where its sign differs, by false position after Illinois.
template <class Function>
double zeroBetween(double low, double high, double at_low, double at_high, Function function,
                   double closed = kClosed) noexcept {
    int side = 0;
    for (int i = 0; i < kSteps && high - low > closed; ++i) {
        double t = at_high == at_low ? 0.5 * (low + high) : (low * at_high - high * at_low) / (at_high - at_low);
        if (!(t > low && t < high)) t = 0.5 * (low + high);
        const double value = function(t);
        if (std::abs(value) < 1e-18) return t;
        if ((value > 0.0) == (at_high > 0.0)) {
            if (side == 1) at_low *= 0.5;
            high = t;
            at_high = value;
            side = 1;
        } else {
            if (side == -1) at_high *= 0.5;
            low = t;
            at_low = value;
            side = -1;
        }
    }
    return 0.5 * (low + high);
}

/// Where the faces of two samples cross, of which each is the higher one at its own.
template <class Walk>
double crossingBetween(const Walk& walk, const SampleOn<Walk>& low, const SampleOn<Walk>& high) noexcept {
    return zeroBetween(
        low.at.t, high.at.t, walk.value(*high.face, low.at) - low.value, high.value - walk.value(*low.face, high.at),
        [&](double t) {
            const auto at = walk.at(t);
            return walk.value(*high.face, at) - walk.value(*low.face, at);
        },
        Walk::kEnough);
}

/// The minimum between two samples of which the first falls and the second rises.
template <class Walk>
Touch minimumBetween(const Walk& walk, SampleOn<Walk> low, SampleOn<Walk> high) noexcept {
    const Lump& lump = walk.lump();
    SampleOn<Walk> here = low;
    for (int i = 0; i < kSteps; ++i) {
        const bool one_face = low.face == high.face;
        const double t = one_face ? zeroBetween(
                                        low.at.t, high.at.t, low.slope, high.slope,
                                        [&](double at) { return walk.slope(*low.face, walk.at(at)); }, Walk::kEnough)
                                  : crossingBetween(walk, low, high);
        here = sampleAt(walk, t);
        const double of_low = walk.value(*low.face, here.at);
        if (here.value > of_low + 1e-15 && here.face != low.face && here.face != high.face) {
            (here.slope < 0.0 ? low : high) = here;  // a third face
            continue;
        }
        if (one_face) return touchAt(Touch::Kind::Smooth, here.at, of_low, placeOf(lump, *low.face));
        const double falls = walk.slope(*low.face, here.at), rises = walk.slope(*high.face, here.at);
        if (falls <= 0.0 && rises >= 0.0) {
            if (std::abs(walk.value(*high.face, here.at) - of_low) > kCrossed) break;
            if (rises - falls <= 0.0) return touchAt(Touch::Kind::Smooth, here.at, of_low, placeOf(lump, *low.face));
            return kinkAt(here.at, of_low, placeOf(lump, *low.face), placeOf(lump, *high.face),
                          rises / (rises - falls));
        }
        if (falls > 0.0)
            high = {of_low, falls, low.face, here.at};
        else
            low = {of_low, rises, high.face, here.at};
    }
    return touchAt(Touch::Kind::Fixed, here.at, here.value, placeOf(lump, *here.face));
}

inline bool isBeside(const Touches& touches, const Curve& line, double t) noexcept {
    for (const Touch& touch : touches.all()) {
        if (apartOn(line, touch.t, t) < (touch.kind == Touch::Kind::Kink ? kBesideKink : kSameTouch)) return true;
    }
    return false;
}

template <class Walk>
void addFixed(const Walk& walk, const SampleOn<Walk>& sample, double reach, Touches& touches,
              std::uint8_t fixed = Touch::kNone) noexcept {
    if (sample.value > reach || isBeside(touches, walk.line(), sample.at.t)) return;
    Touch touch = touchAt(Touch::Kind::Fixed, sample.at, sample.value, placeOf(walk.lump(), *sample.face));
    touch.fixed = fixed;
    touches.add(touch);
}

}  // namespace passung::closed_form
