#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/types.h"
#include "core/field/instructions.h"
#include "core/geometry/mesh.h"

namespace passung::surface {

/// Unit normals sorted into classes, so that a part that slides along a plane is told from one that comes to it: on
/// each side of a cube kSide x kSide cells, whose borders lie at equal angles.
struct NormalClass {
    static constexpr std::size_t kSide = 4;
    static constexpr std::size_t kCount = 6 * kSide * kSide;

    /// Borders of the cells on a cube of edges 2: tan((2 i / kSide - 1) π/4).
    static constexpr std::array<double, kSide + 1> kBorders{-1.0, -0.41421356237309503, 0.0, 0.41421356237309503, 1.0};

    /// Of a direction of any length but 0. rt-safe.
    PASSUNG_INLINE static std::size_t of(const Vec3& n) noexcept {
        const double x = std::abs(n.x()), y = std::abs(n.y()), z = std::abs(n.z());
        const bool by_x = x >= y && x >= z, by_y = !by_x && y >= z;
        const double along = by_x ? x : by_y ? y : z, own = by_x ? n.x() : by_y ? n.y() : n.z();
        const double u = by_x ? n.y() : by_y ? n.z() : n.x(), v = by_x ? n.z() : by_y ? n.x() : n.y();
        const std::size_t axis = by_x ? 0 : by_y ? 1 : 2, side = 2 * axis + (own < 0.0 ? 1 : 0);
        return (side * kSide + placeOf(u, along)) * kSide + placeOf(v, along);
    }

private:
    PASSUNG_INLINE static std::size_t placeOf(double u, double along) noexcept {
        std::size_t k = 0;
        for (std::size_t i = 1; i < kSide; ++i) k += u >= kBorders[i] * along ? 1 : 0;
        return k;
    }
};

/// For each class of normals a length [m].
using PerClass = std::array<double, NormalClass::kCount>;

/// How much nearer any point x of `box` comes to a plane with a normal of the class, at most, when it moves by
/// turn x + move; 0 if it does not. rt-safe.
///   The displacement is affine in x, so that it is largest along a direction at a corner of the box: that of the box'
/// middle and, for each axis, that of half an edge's difference, whichever way it points. A normal of a cell is
/// Σ μ_i c_i / |Σ μ_i c_i| of the cell's corners c_i, Σ μ_i = 1, and |Σ μ_i c_i| ≥ min c_i · e for any unit vector e.
void measureApproach(const geometry::Bounds& box, const Mat3& turn, const Vec3& move, PerClass& nearer) noexcept;

}  // namespace passung::surface
