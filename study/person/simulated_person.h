#pragma once

#include <cstdint>

namespace passung::person {

/// Who a simulated participant is: the traits that stay for all of a person's trials. SI units. Each is drawn from a
/// log-normal distribution about the median named here and kept within the range named here. Medians and spreads are
/// plausible for healthy adults and proposed here; they describe nobody and prove nothing about people.
struct SimulatedPerson {
    double visual_delay = 0.20;        // sight to reaction [s], 0.15 … 0.32
    double haptic_delay = 0.13;        // touch to reaction [s], 0.09 … 0.20
    double arm_mass = 0.5;             // at the handle [kg], 0.3 … 1.0
    double arm_stiffness = 300.0;      // [N/m], 200 … 500
    double arm_damping_ratio = 0.6;    // of the arm alone against its stiffness, 0.4 … 1.0
    double wrist_inertia = 1.5e-3;     // [kg·m²], 0.8e-3 … 3e-3
    double wrist_stiffness = 3.0;      // [N·m/rad], 2 … 4
    double wrist_damping_ratio = 0.6;  // 0.4 … 1.0
    double tremor = 4e-5;              // root mean square per axis [m], 1.5e-5 … 6e-5
    double lateral_error = 1.0e-3;     // of seeing the bore's place, per axis [m], 0.5e-3 … 1.5e-3
    double depth_error = 0.5e-3;       // [m], 0.25e-3 … 0.8e-3
    double tilt_error = 0.013;         // [rad] per axis, 0.008 … 0.018
    double pace = 1.0;                 // of all movements against the usual, 0.7 … 1.4
    double press_force = 3.0;          // while searching [N], 2 … 4

    /// N·s/m and N·m·s/rad from the ratios.
    double armDamping() const;
    double wristDamping() const;
};

/// The person of this stream seed (core/base/random.h: streamSeed); same seed, same person.
SimulatedPerson drawPerson(std::uint64_t seed);

}  // namespace passung::person
