#include "ui/app/simulated_hand.h"

#include "core/base/random.h"
#include "study/person/simulated_person.h"

namespace passung::app {

simulated::HandParams simulatedHand(const protocol::StudyPlan& plan, const std::string& code) {
    // "person" is a phase of its own: who somebody is does not depend on what they do.
    const std::uint64_t seed = streamSeed(plan.name, code, "person", "simulated", plan.seed);
    const person::SimulatedPerson person = person::drawPerson(seed);
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
    hand.approach_duration /= person.pace;
    hand.descend_speed *= person.pace;
    hand.search_speed *= person.pace;
    hand.insert_speed *= person.pace;
    hand.press_force = person.press_force;
    return hand;
}

}  // namespace passung::app
