#include "study/run/person/simulated_hand.h"

namespace passung::run {

simulated::HandParams simulatedHand(const person::SimulatedPerson& person, std::int64_t trials_before) {
    const double pace = person.paceAfter(trials_before);
    simulated::HandParams hand;
    hand.mass = person.arm_mass;
    hand.inertia = person.wrist_inertia;
    hand.stiffness = person.arm_stiffness;
    hand.damping = person.armDamping();
    hand.rotational_stiffness = person.wrist_stiffness;
    hand.rotational_damping = person.wristDamping();
    hand.tremor = person.tremor;
    hand.visual_delay = person.visual_delay;
    hand.haptic_delay = person.haptic_delay;
    hand.lateral_error = person.lateral_error;
    hand.depth_error = person.depth_error;
    hand.tilt_error = person.tilt_error;
    hand.approach_duration /= pace;
    hand.descend_speed *= pace;
    hand.search_speed *= pace;
    hand.insert_speed *= pace;
    hand.press_force = person.press_force;
    hand.insert_force = person.strength;
    hand.lapse_rate = person.lapse_rate;
    hand.lapse_duration = person.lapse_duration;
    hand.feeling_error = person.feeling_error;
    hand.visual_cue = {person.colour_threshold, person.colour_delay, person.colour_noise};
    hand.vibration_cue = {person.vibration_threshold, person.vibration_delay, person.vibration_noise};
    hand.sound_cue = {person.knock_threshold, person.knock_delay, person.knock_noise};
    return hand;
}

}  // namespace passung::run
