// A force m A w² sin(w t) moves a free mass m by A sin(w t); three such sines of amplitude A = a sqrt(2/3) have the
// root mean square a.
#include "devices/simulated/tremor.h"

#include <cmath>
#include <numbers>

namespace passung::simulated {

Tremor::Tremor(double amplitude, double mass, Random& random) {
    for (auto& axis : sines_) {
        for (Sine& sine : axis) {
            sine.omega = 2.0 * std::numbers::pi * random.uniform(8.0, 12.0);
            sine.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
            sine.force = mass * amplitude * std::sqrt(2.0 / 3.0) * sine.omega * sine.omega;
        }
    }
}

Vec3 Tremor::force(double t) const noexcept {
    Vec3 sum = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
        for (const Sine& sine : sines_[static_cast<std::size_t>(axis)])
            sum[axis] += sine.force * std::sin(sine.omega * t + sine.phase);
    return sum;
}

}  // namespace passung::simulated
