#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace passung::field {

/// How a distance field is read between its nodes. All modes read the same stored values; P: the point, s: the edge of
/// its cell, C: the node nearest to P (the centre of the thesis's voxel around P), w: the stored distances; φ = -V.
/// What each reads of them, and by how much φ is off on a surface that is smooth, within half a cell:
///   Layered       s · round(w(C) / s) + n · (P - C)                 1 value     s/2 on a plane; at most s (1/2 + √3)
///   SurfacePoint  m · (P - S(C)),  S(C) = C - w(C) m                7 values    3/8 κ s², on a plane 0
///   Linear        w(C) + one-sided differences · (P - C)            4 values    1/4 (κ₁ + κ₂) s², on a plane 0
///   Trilinear     between the cell's corners                        8 values    0.13 (κ₁ + κ₂) s², on a plane 0
///   Cubic         Catmull-Rom's curves along x, y, z (Keys 1981)    64 values   0.3 κ² s³, on a plane 0
///
/// κ₁, κ₂: principal curvatures, κ the larger. Near sharp edges each errs by O(s). To all of them add the rounding of
/// the stored numbers (DistanceField), times Σ|weights|: 1 for trilinear, at most 4 for linear, 2 for cubic. What each
/// costs in time `passung bench` tells; many points at once are read in trilinear only (DistanceField::sampleMany).
///
/// Source: Sagardia 2019, section 3.2 (V_L, V_S and V_I, eqs. 3.28-3.29; the first two reconstructed). Deviations:
///   layered: layers are rounded Euclidean distances and not counted from voxel to voxel, so they do not drift from the
///     true distance; of bricks of several sizes s is the cell around P. n is the inward normal of the surface that
///     asks (DistanceField::sample), as there; its sign is the one that makes V grow inwards. Without it: n = 0.
///   surface_point: S(C) is not stored but follows from w and the unit gradient m at C (central differences, at the
///     border of a brick one-sided of the second order). The distance is taken along m, not as |P - S(C)|, which would
///     err by O(s) near the surface.
///   cubic is not the thesis's: continuous, and in a brick its gradient is too; the node beyond a brick's border is
///     extrapolated, f(-1) = 3 f(0) - 3 f(1) + f(2), so that bricks need not be joined, and quadratics stay exact.
/// Layered, surface_point and linear jump between voxels; trilinear and cubic only as DistanceField says.
enum class FieldMode { Layered, SurfacePoint, Linear, Trilinear, Cubic };

inline constexpr std::array kFieldModes{FieldMode::Layered, FieldMode::SurfacePoint, FieldMode::Linear,
                                        FieldMode::Trilinear, FieldMode::Cubic};

/// As in scene files and tables: "surface_point".
constexpr const char* modeName(FieldMode mode) {
    constexpr std::array kNames{"layered", "surface_point", "linear", "trilinear", "cubic"};
    return kNames[static_cast<std::size_t>(mode)];
}

constexpr std::optional<FieldMode> modeNamed(std::string_view name) {
    for (const FieldMode mode : kFieldModes)
        if (name == modeName(mode)) return mode;
    return std::nullopt;
}

}  // namespace passung::field
