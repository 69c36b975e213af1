#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace passung::tick {

/// Poses in turn, and what lies between them, by the length gone along it.
///
/// Symbols: X_i the poses, ρ a radius [m], p position, q rotation; of the piece from X_i to X_{i+1}
///   Δp = p_{i+1} - p_i,   Δφ = log(q_{i+1} q_iᵀ),   L_i = sqrt(|Δp|² + ρ² |Δφ|²).
/// On it position and turn go evenly: X(t) = (p_i + t Δp, exp(t Δφ) q_i), t from 0 to 1.
/// Nearest to X: where |p - p(t)|² + ρ² |log(q q(t)ᵀ)|² is least, on each piece by the projection
///   t = (Δp · (p - p_i) + ρ² Δφ · log(q q_iᵀ))/L_i²,
/// which is exact where it does not turn, or turns about one axis with X.
class GuideWay {
public:
    GuideWay() = default;
    /// Allocates. What does not lead away from the pose before is left out. @pre `radius` > 0
    GuideWay(const Pose& start, std::span<const Pose> on, double radius);

    double length() const noexcept { return pieces_.empty() ? 0.0 : pieces_.back().end; }
    /// @pre 0 ≤ `gone` ≤ length(). rt-safe.
    Pose at(double gone) const noexcept;
    /// How far along it is nearest to `X`, of what lies from `from` to `to`. rt-safe.
    double nearest(const Pose& X, double from, double to) const noexcept;

private:
    struct Piece {
        Pose X;
        Vec3 move, turn;    // Δp, Δφ
        double begin, end;  // along the whole

        Pose at(double t) const noexcept { return {rotationFromVector(t * turn) * X.q, X.p + t * move}; }
    };
    double shareOf(const Piece& piece, double gone) const noexcept;

    double radius_ = 1.0;
    Pose end_;
    std::vector<Piece> pieces_;
};

}  // namespace passung::tick
