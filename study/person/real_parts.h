#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "study/person/simulated_person.h"

namespace passung::person {

/// A trial with real parts in the hand, as an experimenter's clock shows it.
struct RealTrial {
    double time = 0.0;    // [s]
    bool success = true;  // false: the part was dropped
};

/// Proposed here, for dry runs: 0.5 completionTime(), because nothing stands between hand and part, and the
/// experimenter's reaction, normal with mean 0.25 s and standard deviation 0.05 s, at least 0.1 s. Dropped in a fifth
/// of the person's share of lapses. Not measured on anybody.
RealTrial realTrial(const SimulatedPerson& person, std::int64_t trials_before, Random& random);

}  // namespace passung::person
