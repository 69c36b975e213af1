#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/field/distance_field.h"
#include "core/field/interpolation.h"

/// The modes of reading a field (field_mode.h); rt-safe. Part of distance_field.cpp, which inlines it.
namespace passung::field {

namespace field_modes {

inline constexpr double kWhole = 0x1.8p52;   // added and taken away again, leaves a whole number
inline constexpr double kLeastSlope = 1e-6;  // of φ: below, as in the middle of a part, no direction is nearest

using Four = std::array<double, 4>;

/// Four neighbouring nodes of an axis around a point, their weights and what these grow by along a cell.
struct Cubic {
    int first;
    Four weight, slope;
};

/// Keys (1981), a = -1/2 (Catmull-Rom), for a point at `u` in cell `at` of `cells`. In the first and last cell the node
/// beyond is extrapolated from three, so that quadratics stay exact.
inline Cubic cubicAlong(int at, int cells, double u) noexcept {
    const Four w{u * (-0.5 + u * (1.0 - 0.5 * u)), 1.0 + u * u * (-2.5 + 1.5 * u), u * (0.5 + u * (2.0 - 1.5 * u)),
                 u * u * (-0.5 + 0.5 * u)};
    const Four s{-0.5 + u * (2.0 - 1.5 * u), u * (-5.0 + 4.5 * u), 0.5 + u * (4.0 - 4.5 * u), u * (-1.0 + 1.5 * u)};
    const auto beforeFirst = [](const Four& f) { return Four{f[1] + 3.0 * f[0], f[2] - 3.0 * f[0], f[3] + f[0], 0.0}; };
    const auto afterLast = [](const Four& f) { return Four{0.0, f[0] + f[3], f[1] - 3.0 * f[3], f[2] + 3.0 * f[3]}; };
    if (at == 0) return {0, beforeFirst(w), beforeFirst(s)};
    if (at == cells - 1) return {cells - 3, afterLast(w), afterLast(s)};
    return {at - 1, w, s};
}

}  // namespace field_modes

/// The stored numbers of a brick or of the coarse grid. @pre three cells or more along each axis.
template <class Number>
struct DistanceField::Lattice {
    const Number* numbers;
    const Spot& spot;
    std::array<std::ptrdiff_t, 3> stride;

    Lattice(const Number* first, const Spot& s) : numbers(first), spot(s) {
        stride = {1, s.cells[0] + 1, std::ptrdiff_t{s.cells[0] + 1} * (s.cells[1] + 1)};
    }

    const Number* node(const std::array<int, 3>& i) const noexcept {
        return numbers + i[0] + i[1] * stride[1] + i[2] * stride[2];
    }
    static double read(const Number* node) noexcept { return static_cast<double>(*node); }

    /// The node nearest to the point: the centre C of the thesis's voxel around it.
    struct Voxel {
        std::array<int, 3> at;
        Vec3 way;  // P - C, in cells
    };
    Voxel voxel() const noexcept {  // without branches: no processor could foresee them
        Voxel found;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const int high = spot.u[static_cast<int>(axis)] > 0.5 ? 1 : 0;
            found.at[axis] = spot.at[axis] + high;
            found.way[static_cast<int>(axis)] = spot.u[static_cast<int>(axis)] - high;
        }
        return found;
    }

    /// Source: Sagardia 2019, V_L.  φ = s · round(w(C) / s) + n · (P - C)
    FieldSample layered(const Vec3& inward) const noexcept {
        const Voxel C = voxel();
        const double w = spot.low + spot.step * read(node(C.at));
        const double layer = (w * spot.inverse_edge + field_modes::kWhole) - field_modes::kWhole;
        return {spot.edge * (layer + inward.dot(C.way)), inward};
    }

    /// Source: Sagardia 2019, V_S.  φ = m · (P - S(C)) = w(C) + m · (P - C)
    FieldSample surfacePoint() const noexcept {
        const Voxel C = voxel();
        const Number* const centre = node(C.at);
        Vec3 slope;  // of the stored numbers, per cell
        for (unsigned axis = 0; axis < 3; ++axis) {
            const int i = C.at[axis], last = spot.cells[axis];
            const std::ptrdiff_t inside = i == 0 ? stride[axis] : i == last ? -stride[axis] : 0;
            slope[static_cast<int>(axis)] =
                inside == 0 ? 0.5 * (read(centre + stride[axis]) - read(centre - stride[axis]))
                            : (2.0 * read(centre + inside) - 1.5 * read(centre) - 0.5 * read(centre + 2 * inside)) *
                                  (i == 0 ? 1.0 : -1.0);
        }
        const double w = spot.low + spot.step * read(centre);
        const double length = slope.norm();
        if (!(length * spot.step * spot.inverse_edge > field_modes::kLeastSlope)) return {w, Vec3::Zero()};
        const Vec3 m = slope / length;
        return {w + spot.edge * m.dot(C.way), m};
    }

    /// Source: Sagardia 2019, V_I, eqs. 3.28-3.29.
    FieldSample linear() const noexcept {
        const Voxel C = voxel();
        const Number* const centre = node(C.at);
        const double c = read(centre);
        double value = c;
        Vec3 gradient;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const int towards = 1 - 2 * (C.at[axis] - spot.at[axis]);  // where the cell lies
            const double slope = towards * (read(centre + towards * stride[axis]) - c);
            value += slope * C.way[static_cast<int>(axis)];
            gradient[static_cast<int>(axis)] = slope * (spot.step * spot.inverse_edge);
        }
        return {spot.low + spot.step * value, gradient};
    }

    FieldSample cubic() const noexcept {
        const auto x = field_modes::cubicAlong(spot.at[0], spot.cells[0], spot.u.x());
        const auto y = field_modes::cubicAlong(spot.at[1], spot.cells[1], spot.u.y());
        const auto z = field_modes::cubicAlong(spot.at[2], spot.cells[2], spot.u.z());
        double value = 0.0;
        Vec3 slope = Vec3::Zero();
        const Number* slab = node({x.first, y.first, z.first});
        for (std::size_t k = 0; k < 4; ++k, slab += stride[2]) {
            double v = 0.0, along_x = 0.0, along_y = 0.0;
            const Number* row = slab;
            for (std::size_t j = 0; j < 4; ++j, row += stride[1]) {
                const field_modes::Four f{read(row), read(row + 1), read(row + 2), read(row + 3)};
                const double at = f[0] * x.weight[0] + f[1] * x.weight[1] + f[2] * x.weight[2] + f[3] * x.weight[3];
                const double by_x = f[0] * x.slope[0] + f[1] * x.slope[1] + f[2] * x.slope[2] + f[3] * x.slope[3];
                v += y.weight[j] * at;
                along_x += y.weight[j] * by_x;
                along_y += y.slope[j] * at;
            }
            value += z.weight[k] * v;
            slope += Vec3(z.weight[k] * along_x, z.weight[k] * along_y, z.slope[k] * v);
        }
        return {spot.low + spot.step * value, slope * (spot.step * spot.inverse_edge)};
    }

    FieldSample sample(FieldMode mode, const Vec3& inward) const noexcept {
        switch (mode) {
            case FieldMode::Layered:
                return layered(inward);
            case FieldMode::SurfacePoint:
                return surfacePoint();
            case FieldMode::Linear:
                return linear();
            case FieldMode::Trilinear:
            case FieldMode::Cubic:
                break;
        }
        return cubic();
    }
};

}  // namespace passung::field
