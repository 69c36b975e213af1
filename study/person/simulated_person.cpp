#include "study/person/simulated_person.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/random.h"

namespace passung::person {
namespace {

using P = SimulatedPerson;

// The order is part of the definition: a new trait goes to the end, so that known persons stay who they are.
constexpr std::array<Trait, 32> kTraits = {{
    {"visual_delay", "s", "sight to reaction", &P::visual_delay, 0.15, 0.15, 0.32},
    {"haptic_delay", "s", "touch to reaction", &P::haptic_delay, 0.15, 0.09, 0.20},
    {"arm_mass", "kg", "at the handle", &P::arm_mass, 0.25, 0.3, 1.0},
    {"arm_stiffness", "N/m", "of the arm", &P::arm_stiffness, 0.2, 200.0, 500.0},
    {"arm_damping_ratio", "1", "of the arm alone against its stiffness", &P::arm_damping_ratio, 0.15, 0.4, 1.0},
    {"wrist_inertia", "kg m2", "at the handle", &P::wrist_inertia, 0.2, 0.8e-3, 3e-3},
    {"wrist_stiffness", "N m/rad", "of the wrist", &P::wrist_stiffness, 0.15, 2.0, 4.0},
    {"wrist_damping_ratio", "1", "of the wrist alone", &P::wrist_damping_ratio, 0.15, 0.4, 1.0},
    {"tremor", "m", "root mean square per axis of the free hand", &P::tremor, 0.3, 1.5e-5, 6e-5},
    {"lateral_error", "m", "of seeing where the bore is, per axis", &P::lateral_error, 0.25, 0.5e-3, 1.5e-3},
    {"depth_error", "m", "of seeing how deep it lies", &P::depth_error, 0.25, 0.25e-3, 0.8e-3},
    {"tilt_error", "rad", "of seeing its direction, per axis", &P::tilt_error, 0.2, 0.008, 0.018},
    {"pace", "1", "of all movements, practised, against the usual", &P::pace, 0.15, 0.7, 1.4},
    {"press_force", "N", "while searching", &P::press_force, 0.15, 2.0, 4.0},
    {"strength", "N", "the most that is pushed", &P::strength, 0.2, 5.0, 10.0},
    {"learning", "1", "how much slower the session's first trial is than a practised one", &P::learning, 0.5, 0.05,
     0.7},
    {"learning_trials", "1", "trials after which 1/e of that is left", &P::learning_trials, 0.4, 3.0, 24.0},
    {"lapse_rate", "1", "share of trials with a lapse: lost in thought before the part is lowered", &P::lapse_rate, 0.6,
     0.004, 0.1},
    {"lapse_duration", "s", "of a lapse", &P::lapse_duration, 0.3, 0.7, 3.5},
    {"reaction_time", "s", "to a stimulus of a secondary task, with nothing else to do", &P::reaction_time, 0.15, 0.25,
     0.7},
    {"reaction_load", "1", "how much longer that takes while a part touches", &P::reaction_load, 0.4, 0.05, 0.9},
    {"miss_rate", "1", "share of stimuli that go unnoticed, with nothing else to do", &P::miss_rate, 0.6, 0.005, 0.25},
    {"feeling_error", "1", "of comparing: standard deviation of the logarithm of what an interval felt like",
     &P::feeling_error, 0.3, 0.05, 0.3},
    {"colour_threshold", "1", "of the visual cue: what is weaker, in parts of its full strength, goes unnoticed",
     &P::colour_threshold, 0.3, 0.05, 0.4},
    {"colour_delay", "s", "visual cue to reaction", &P::colour_delay, 0.15, 0.2, 0.42},
    {"colour_noise", "1", "of the visual cue: standard deviation of the logarithm of its strength", &P::colour_noise,
     0.3, 0.1, 0.6},
    {"vibration_threshold", "1", "as colour_threshold, of the vibrotactile cue", &P::vibration_threshold, 0.3, 0.02,
     0.3},
    {"vibration_delay", "s", "vibrotactile cue to reaction", &P::vibration_delay, 0.15, 0.14, 0.35},
    {"vibration_noise", "1", "as colour_noise, of the vibrotactile cue", &P::vibration_noise, 0.3, 0.1, 0.7},
    {"knock_threshold", "1", "as colour_threshold, of the sound of an impact", &P::knock_threshold, 0.3, 0.03, 0.4},
    {"knock_delay", "s", "that sound to reaction", &P::knock_delay, 0.15, 0.12, 0.3},
    {"knock_noise", "1", "as colour_noise, of that sound", &P::knock_noise, 0.3, 0.1, 0.6},
}};

}  // namespace

double SimulatedPerson::armDamping() const { return 2.0 * arm_damping_ratio * std::sqrt(arm_stiffness * arm_mass); }

double SimulatedPerson::wristDamping() const {
    return 2.0 * wrist_damping_ratio * std::sqrt(wrist_stiffness * wrist_inertia);
}

double SimulatedPerson::paceAfter(std::int64_t trials_before) const {
    PASSUNG_ASSERT(trials_before >= 0);
    return pace / (1.0 + learning * std::exp(-static_cast<double>(trials_before) / learning_trials));
}

std::span<const Trait> traits() { return kTraits; }

SimulatedPerson drawPerson(std::uint64_t seed) {
    Random random(seed);
    SimulatedPerson person;
    for (const Trait& trait : kTraits) {
        double& value = person.*trait.value;
        value = std::clamp(value * std::exp(trait.spread * random.normal()), trait.low, trait.high);
    }
    return person;
}

SimulatedPerson personOf(std::string_view study, std::string_view code, std::uint64_t study_seed) {
    return drawPerson(streamSeed(study, code, "person", "simulated", study_seed));
}

}  // namespace passung::person
