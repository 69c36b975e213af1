#pragma once

#include "core/closed_form/solid.h"

// What solids are made of, whoever makes them.

namespace passung::closed_form {

inline Curve straight(const Vec3& from, const Vec3& to) {
    return {Curve::Kind::Straight, 0.5 * (from + to), 0.5 * (to - from), Vec3::Zero(), 1.0, 0.0};
}

/// The planes z = low and z = high.
inline void addEnds(double low, double high, Lump& lump) {
    lump.faces.push_back(plane({0, 0, high}, {0, 0, 1}));
    lump.faces.push_back(plane({0, 0, low}, {0, 0, -1}));
}

}  // namespace passung::closed_form
