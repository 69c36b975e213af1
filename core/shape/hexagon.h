#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace passung::shape {

/// Signed distance of (x, y) to a regular hexagon about the origin, `width` across flats, flats towards ±x.
inline double hexagonDistance(double width, double x, double y) {
    constexpr double kRoot = 0.5 * std::numbers::sqrt3;
    // By symmetry beside the flat towards +x.
    const double u = std::abs(x), v = std::abs(y), turned = 0.5 * u + kRoot * v;
    const double out = std::max(u, turned) - 0.5 * width;
    if (out <= 0.0) return out;
    const double along = turned > u ? std::abs(kRoot * u - 0.5 * v) : v;
    return std::hypot(out, std::max(0.0, along - 0.5 * width / std::numbers::sqrt3));
}

/// How far it reaches in the direction φ.
inline double hexagonReach(double width, double phi) {
    constexpr double kSector = std::numbers::pi / 3.0;
    return 0.5 * width / std::cos(phi - kSector * std::round(phi / kSector));
}

}  // namespace passung::shape
