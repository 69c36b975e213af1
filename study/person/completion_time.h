#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "study/person/simulated_person.h"

namespace passung::person {

/// How long a person takes for a trial of insertion after so many others of the session, without any simulation of
/// hand, device or contact, and alike in all conditions [s]: ex-Gaussian, as times of people often are,
///   (normal of mean 2.6 and standard deviation 0.25, at least 1, + exponential of mean 0.6) /
///   paceAfter(trials_before),
/// and a lapse's duration more in the person's share of trials. Proposed here; the mean is near that of the simulated
/// hand in protocols/peg_in_hole. For dry runs of design and analysis.
double completionTime(const SimulatedPerson& person, std::int64_t trials_before, Random& random);

}  // namespace passung::person
