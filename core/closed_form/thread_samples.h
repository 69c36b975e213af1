#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/closed_form/solid.h"
#include "core/field/instructions.h"

namespace passung::closed_form {

/// A place on a line as faces about the z axis see it, and how it moves by t.
struct ThreadPoint {
    double t = 0.0;
    double cosine = 0.0, sine = 0.0;  // of t on a circle, else 0 and 0
    Vec3 p = Vec3::Zero();
    Vec3 by_t = Vec3::Zero();
    double r = 0.0, phi = 0.0;
    double r_by_t = 0.0, phi_by_t = 0.0;
};

ThreadPoint threadPoint(const Curve& line, double t) noexcept;  // rt-safe

/// Points along a piece of a line, which serve for all lumps that it meets.
class ThreadSamples {
public:
    static constexpr std::size_t kMost = 16;  // pieces of a turn
    static constexpr std::size_t kRoom = 24;  // a multiple of what is computed at once
    using Row = std::array<double, kRoom>;

    /// With the best instructions of this machine: all have the same bits. rt-safe.
    void take(const Curve& line, const LinePiece& piece) noexcept;
    void take(const Curve& line, const LinePiece& piece, field::Instructions instructions) noexcept;

    std::size_t pieces() const noexcept { return pieces_; }
    ThreadPoint operator[](std::size_t i) const noexcept;

    // The first pieces() + 1 of each.
    alignas(64) Row t{}, x{}, y{}, z{};      // [m]
    alignas(64) Row by_x{}, by_y{}, by_z{};  // derivatives of these by t
    alignas(64) Row r{}, phi{}, r_by_t{}, phi_by_t{};

private:
    void set(std::size_t i, const ThreadPoint& at) noexcept;

    std::size_t pieces_ = 0;
};

/// What a lump's faces are at such points.
struct ThreadHeights {
    using Row = ThreadSamples::Row;

    alignas(64) Row value, slope;  // of the highest face, and by t [m]
    alignas(64) Row bound;         // below
    alignas(64) Row away;          // from the flank's middle line: fromFlank() [m]
    alignas(64) Row across;        // how the line goes along the axis, as ridges see it, by t [m]
    alignas(64) std::array<std::int64_t, ThreadSamples::kRoom> face;  // the highest one, among the others
    static constexpr std::int64_t kFlank = -1;

    /// Of a flank, or none, and other faces. The function is above `reach` on all places that are less than `bound`
    /// less `reach` away: where the next turn's flank begins to count it jumps. rt-safe.
    void take(const ThreadSamples& samples, std::span<const Face* const> others, const Face* flank,
              double reach) noexcept;
    void take(const ThreadSamples& samples, std::span<const Face* const> others, const Face* flank, double reach,
              field::Instructions instructions) noexcept;
};

/// Outwards along the axis from the middle of the flank's ridge, if that is the nearest; `away`: fromFlank() [m].
inline double outOfRidge(const Face& flank, double away) noexcept {
    const double out = away + 0.25 * flank.pitch;
    return out > 0.5 * flank.pitch ? out - flank.pitch : out;
}

}  // namespace passung::closed_form
