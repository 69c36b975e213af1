#include "study/person/simulated_person.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace passung::person {
namespace {

/// `value` holds the median; exp(spread · normal) times it, inside the range.
void draw(Random& random, double& value, double spread, double low, double high) {
    value = std::clamp(value * std::exp(spread * random.normal()), low, high);
}

}  // namespace

double SimulatedPerson::armDamping() const { return 2.0 * arm_damping_ratio * std::sqrt(arm_stiffness * arm_mass); }

double SimulatedPerson::wristDamping() const {
    return 2.0 * wrist_damping_ratio * std::sqrt(wrist_stiffness * wrist_inertia);
}

// The order of the draws is part of the definition: a new trait goes to the end, so that known persons stay who they
// are.
SimulatedPerson drawPerson(std::uint64_t seed) {
    Random random(seed);
    SimulatedPerson p;
    draw(random, p.visual_delay, 0.15, 0.15, 0.32);
    draw(random, p.haptic_delay, 0.15, 0.09, 0.20);
    draw(random, p.arm_mass, 0.25, 0.3, 1.0);
    draw(random, p.arm_stiffness, 0.2, 200.0, 500.0);
    draw(random, p.arm_damping_ratio, 0.15, 0.4, 1.0);
    draw(random, p.wrist_inertia, 0.2, 0.8e-3, 3e-3);
    draw(random, p.wrist_stiffness, 0.15, 2.0, 4.0);
    draw(random, p.wrist_damping_ratio, 0.15, 0.4, 1.0);
    draw(random, p.tremor, 0.3, 1.5e-5, 6e-5);
    draw(random, p.lateral_error, 0.25, 0.5e-3, 1.5e-3);
    draw(random, p.depth_error, 0.25, 0.25e-3, 0.8e-3);
    draw(random, p.tilt_error, 0.2, 0.008, 0.018);
    draw(random, p.pace, 0.15, 0.7, 1.4);
    draw(random, p.press_force, 0.15, 2.0, 4.0);
    return p;
}

}  // namespace passung::person
