#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace passung::person {

/// Who a simulated participant is: the traits that stay for all of a person's trials. SI units; unit, spread and range
/// of each: traits(). The values here are the medians. Medians and spreads are plausible for healthy adults and
/// proposed here; they describe nobody and prove nothing about people.
struct SimulatedPerson {
    double visual_delay = 0.20;
    double haptic_delay = 0.13;
    double arm_mass = 0.5;
    double arm_stiffness = 300.0;
    double arm_damping_ratio = 0.6;
    double wrist_inertia = 1.5e-3;
    double wrist_stiffness = 3.0;
    double wrist_damping_ratio = 0.6;
    double tremor = 4e-5;
    double lateral_error = 1.0e-3;
    double depth_error = 0.5e-3;
    double tilt_error = 0.013;
    double pace = 1.0;
    double press_force = 3.0;
    double strength = 7.0;
    double learning = 0.25;
    double learning_trials = 8.0;
    double lapse_rate = 0.02;
    double lapse_duration = 1.5;
    double reaction_time = 0.38;
    double reaction_load = 0.3;
    double miss_rate = 0.04;
    double feeling_error = 0.12;
    double colour_threshold = 0.15;
    double colour_delay = 0.28;
    double colour_noise = 0.25;
    double vibration_threshold = 0.08;
    double vibration_delay = 0.22;
    double vibration_noise = 0.30;
    double knock_threshold = 0.10;
    double knock_delay = 0.18;
    double knock_noise = 0.25;

    /// N·s/m and N·m·s/rad from the ratios.
    double armDamping() const;
    double wristDamping() const;

    /// Pace in a trial after so many others of the session: practice makes faster, by the exponential law
    /// pace / (1 + learning · exp(-trials_before / learning_trials)). @pre trials_before ≥ 0
    double paceAfter(std::int64_t trials_before) const;
};

/// One trait: exp(spread · normal) times the median, kept in [low, high].
struct Trait {
    const char* name;
    const char* unit;  // "1": none
    const char* meaning;
    double SimulatedPerson::*value;
    double spread;  // standard deviation of the natural logarithm, before it is kept in the range
    double low, high;
};

/// Every trait, in the order in which they are drawn.
std::span<const Trait> traits();

/// The person of this seed; same seed, same person.
SimulatedPerson drawPerson(std::uint64_t seed);

/// The simulated participant `code` of a study: the same in all their trials and sessions (stream "simulated" of the
/// code, in a phase of its own, because who somebody is does not depend on what they do).
SimulatedPerson personOf(std::string_view study, std::string_view code, std::uint64_t study_seed);

}  // namespace passung::person
