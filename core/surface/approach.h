#pragma once

#include <array>
#include <cstddef>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::surface {

/// Unit normals sorted into classes, so that a part that slides along a plane is told from one that comes to it: on
/// each side of a cube kSide x kSide cells, whose borders lie at equal angles.
struct NormalClass {
    static constexpr std::size_t kSide = 4;
    static constexpr std::size_t kCount = 6 * kSide * kSide;

    /// Of a direction of any length but 0. rt-safe.
    static std::size_t of(const Vec3& n) noexcept;
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
