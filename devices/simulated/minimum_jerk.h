#pragma once

#include <algorithm>

#include "core/base/types.h"

namespace passung::simulated {

/// Share of the way after the share `tau` of the time: the smoothest reach that starts and ends at rest
/// (Flash and Hogan 1985), s = 10 τ³ - 15 τ⁴ + 6 τ⁵; clamped to [0, 1]. Peak speed 15/8 of the mean, at half time.
inline double minimumJerk(double tau) noexcept {
    const double t = std::clamp(tau, 0.0, 1.0);
    return t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

/// A reach from one pose to another, position straight, rotation along the shortest arc.
struct Reach {
    Pose from, to;
    double duration = 1.0;  // [s], > 0

    Pose at(double t) const noexcept {
        const double s = minimumJerk(t / duration);
        const Vec3 turn = rotationVector(to.q * from.q.conjugate());
        return {(rotationFromVector(s * turn) * from.q).normalized(), from.p + s * (to.p - from.p)};
    }
};

}  // namespace passung::simulated
