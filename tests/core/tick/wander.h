#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace passung::test {

/// A smooth function in [-1, 1] that begins at rest at 0: three sines under a ramp.
class Wander {
public:
    /// `ramp`: until it wanders freely [s].
    Wander(Random& random, double most_hz, double ramp) : ramp_(ramp) {
        for (std::size_t i = 0; i < 3; ++i) {
            rate_[i] = 2.0 * std::numbers::pi * random.uniform(0.1, most_hz);
            phase_[i] = random.uniform(0.0, 2.0 * std::numbers::pi);
        }
    }
    double at(double t) const {
        const double s = std::clamp(t / ramp_, 0.0, 1.0), ramp = s * s * (3.0 - 2.0 * s);
        double sum = 0.0;
        for (std::size_t i = 0; i < 3; ++i) sum += std::sin(rate_[i] * t + phase_[i]);
        return ramp * sum / 3.0;
    }

private:
    double ramp_;
    std::array<double, 3> rate_{}, phase_{};
};

}  // namespace passung::test
