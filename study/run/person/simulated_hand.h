#pragma once

#include <cstdint>

#include "devices/simulated/hand_params.h"
#include "study/person/simulated_person.h"

namespace passung::run {

/// The person's arm, senses and habits in a trial after so many others of the session.
simulated::HandParams simulatedHand(const person::SimulatedPerson& person, std::int64_t trials_before);

}  // namespace passung::run
