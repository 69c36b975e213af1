#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/triangle_distance.h"

/// Parts of triangles: what a search cuts where a whole one says too little.
namespace passung::query {

/// The middles of the sixteen parts of a triangle that is quartered twice, along two of its sides.
inline constexpr auto kSixteenths = [] {
    std::array<std::array<double, 2>, 16> middles{};
    std::size_t n = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; i + j < 4; ++j) {
            middles[n++] = {(i + 1.0 / 3.0) / 4.0, (j + 1.0 / 3.0) / 4.0};
            if (i + j < 3) middles[n++] = {(i + 2.0 / 3.0) / 4.0, (j + 2.0 / 3.0) / 4.0};
        }
    return middles;
}();

inline std::array<geometry::TriangleCorners, 4> quarters(const geometry::TriangleCorners& t) {
    const Vec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
    return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

struct FarthestCorner {
    double distance;  // [m]
    std::size_t corner;
};

/// The corner of `piece` that is farthest from the triangle `t`: no point of the piece is farther.
inline FarthestCorner farthestFrom(const geometry::TriangleCorners& t, const geometry::TriangleCorners& piece) {
    FarthestCorner farthest{-1.0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = (geometry::closestOnTriangle(piece[i], t[0], t[1], t[2]) - piece[i]).norm();
        if (d > farthest.distance) farthest = {d, i};
    }
    return farthest;
}

}  // namespace passung::query
