#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/closed_form/solid.h"
#include "core/field/instructions.h"

namespace passung::closed_form {

/// Places on a whole circle, the last where the first is, each with the highest of some faces there, the value of its
/// function and the slope of that by the circle's parameter.
struct CircleSamples {
    static constexpr std::size_t kPieces = kCirclePieces;
    static constexpr std::size_t kRoom = 32;  // a multiple of what is computed at once

    template <class Number>
    using Row = std::array<Number, kRoom>;
    alignas(64) Row<double> x, y, z;              // [m]
    alignas(64) Row<double> way_x, way_y, way_z;  // derivatives of these by the parameter
    alignas(64) Row<double> value;                // [m]
    alignas(64) Row<double> slope;                // [m]
    alignas(64) Row<std::int64_t> face;           // among the faces

    Vec3 point(std::size_t i) const noexcept { return {x[i], y[i], z[i]}; }
    Vec3 way(std::size_t i) const noexcept { return {way_x[i], way_y[i], way_z[i]}; }

    /// Of the i-th: from -π on.
    static double parameter(std::size_t i) noexcept;

    /// The bits of valueOf() and gradientOf(), many at once. False where the faces are of another kind than plane,
    /// cylinder and cone, or a sample is on an axis: then only points and ways are told. @pre a whole circle, a face.
    /// rt-safe.
    bool take(const Curve& circle, std::span<const Face* const> faces) noexcept;
    /// Not with the best instructions of this machine, for tests.
    bool take(const Curve& circle, std::span<const Face* const> faces, field::Instructions instructions) noexcept;
};

}  // namespace passung::closed_form
