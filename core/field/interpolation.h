#pragma once

#include <array>
#include <cstddef>

#include "core/base/types.h"

/// Interpolation in one cubic cell; rt-safe. CornerValues are numbered by bits (1: x, 2: y, 4: z), `u` are the local
/// coordinates in [0, 1]³.
namespace passung::field {

using CornerValues = std::array<double, 8>;

/// The corner `i` in local coordinates.
inline Vec3 cornerAt(std::size_t i) noexcept { return {(i & 1) ? 1.0 : 0.0, (i & 2) ? 1.0 : 0.0, (i & 4) ? 1.0 : 0.0}; }

/// Weight of each corner's value in trilinearValue; their sum is 1.
inline CornerValues trilinearWeights(const Vec3& u) noexcept {
    CornerValues w{};
    for (std::size_t i = 0; i < 8; ++i) {
        w[i] = ((i & 1) ? u.x() : 1.0 - u.x()) * ((i & 2) ? u.y() : 1.0 - u.y()) * ((i & 4) ? u.z() : 1.0 - u.z());
    }
    return w;
}

/// The four values on the cell's edges along x: bits 1: y, 2: z.
inline std::array<double, 4> alongX(const CornerValues& c, double x) noexcept {
    return {c[0] + x * (c[1] - c[0]), c[2] + x * (c[3] - c[2]), c[4] + x * (c[5] - c[4]), c[6] + x * (c[7] - c[6])};
}

/// Along x, then y, then z.
inline double trilinearValue(const CornerValues& c, const Vec3& u) noexcept {
    const auto [x00, x10, x01, x11] = alongX(c, u.x());
    const double y0 = x00 + u.y() * (x10 - x00), y1 = x01 + u.y() * (x11 - x01);
    return y0 + u.z() * (y1 - y0);
}

/// Derivative of trilinearValue by the local coordinates.
inline Vec3 trilinearSlope(const CornerValues& c, const Vec3& u) noexcept {
    const auto [x00, x10, x01, x11] = alongX(c, u.x());
    const double dx0 = (c[1] - c[0]) + u.y() * ((c[3] - c[2]) - (c[1] - c[0]));
    const double dx1 = (c[5] - c[4]) + u.y() * ((c[7] - c[6]) - (c[5] - c[4]));
    const double dy0 = x10 - x00, dy1 = x11 - x01;
    const double y0 = x00 + u.y() * dy0, y1 = x01 + u.y() * dy1;
    return {dx0 + u.z() * (dx1 - dx0), dy0 + u.z() * (dy1 - dy0), y1 - y0};
}

/// The corner nearest to u, which is the centre of the thesis's voxel around the point.
inline unsigned nearestCorner(const Vec3& u) noexcept {
    return (u.x() > 0.5 ? 1u : 0u) | (u.y() > 0.5 ? 2u : 0u) | (u.z() > 0.5 ? 4u : 0u);
}

}  // namespace passung::field
