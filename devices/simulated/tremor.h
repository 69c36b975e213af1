#pragma once

#include <array>

#include "core/base/random.h"
#include "core/base/types.h"

namespace passung::simulated {

/// Physiological tremor: per axis three sines of 8 to 12 Hz with random phases. rt-safe after construction.
class Tremor {
public:
    /// `amplitude`: root mean square displacement per axis of a free `mass` that this force would shake.
    Tremor(double amplitude, double mass, Random& random);
    /// Muscle force [N] at time `t` [s].
    Vec3 force(double t) const noexcept;

private:
    struct Sine {
        double omega = 0.0, phase = 0.0, force = 0.0;
    };
    std::array<std::array<Sine, 3>, 3> sines_;
};

}  // namespace passung::simulated
