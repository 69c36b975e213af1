#pragma once

#include <array>
#include <cstdint>

#include "core/closed_form/touch_search.h"

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

    /// rt-safe
    void take(const Curve& line, const LinePiece& piece) noexcept;
    std::size_t pieces() const noexcept { return pieces_; }
    const ThreadPoint& operator[](std::size_t i) const noexcept { return points_[i]; }

private:
    void takeTurn(const Curve& spiral, const LinePiece& piece) noexcept;

    std::size_t pieces_ = 0;
    std::array<ThreadPoint, kMost + 1> points_;
};

/// As searchEdge(), along a spiral, or along any edge that meets a lump with a thread's flank. `samples` of `piece`.
/// The bound is proven where it is above 0 only: amid a ridge the function jumps, so that none is of how deep it lies.
/// @pre reach ≥ 0
double searchAlongThread(const Curve& edge, const LinePiece& piece, const ThreadSamples& samples, const Lump& lump,
                         double reach, Touches& touches) noexcept;

bool hasFlank(const Lump& lump) noexcept;

}  // namespace passung::closed_form
