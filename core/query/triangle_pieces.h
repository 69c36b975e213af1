#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/triangle_distance.h"

/// Parts of triangles: what a search cuts where a whole one says too little.
namespace passung::query {

/// Across the longest edge.
inline std::array<geometry::TriangleCorners, 2> halves(const geometry::TriangleCorners& t) {
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if ((t[(i + 1) % 3] - t[i]).squaredNorm() > (t[(k + 1) % 3] - t[k]).squaredNorm()) k = i;
    const Vec3 &a = t[k], &b = t[(k + 1) % 3], &apex = t[(k + 2) % 3], middle = 0.5 * (a + b);
    return {{{a, middle, apex}, {middle, b, apex}}};
}

/// Along the line on which a function that is linear on the triangle is zero; `values` at the corners, one of which has
/// another sign than the two others.
inline std::array<geometry::TriangleCorners, 3> partsAtZero(const geometry::TriangleCorners& t,
                                                            const std::array<double, 3>& values) {
    std::size_t k = 0;  // the corner on a side of its own
    while ((values[k] > 0.0) == (values[(k + 1) % 3] > 0.0) || (values[k] > 0.0) == (values[(k + 2) % 3] > 0.0)) ++k;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 on_i = t[k] + values[k] / (values[k] - values[i]) * (t[i] - t[k]);
    const Vec3 on_j = t[k] + values[k] / (values[k] - values[j]) * (t[j] - t[k]);
    return {{{t[k], on_i, on_j}, {on_i, t[i], t[j]}, {on_i, t[j], on_j}}};
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
