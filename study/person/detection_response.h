#pragma once

#include <optional>

#include "core/base/random.h"
#include "study/person/simulated_person.h"

namespace passung::person {

/// What somebody does about one stimulus of a detection-response task [s after its onset].
struct DetectionResponse {
    std::optional<double> press;    // the answer; none: missed
    std::optional<double> mistake;  // a press that nothing asked for, later than any answer
};

/// Proposed here, for dry runs: with `load` from 0 (nothing else to do) to 1 (in contact)
///   missed with probability miss_rate · (1 + 2 load), else after
///   reaction_time · (1 + reaction_load · load) · exp(0.2 · standard normal),
/// and in 3 % of the cases a press by mistake 2.6 s after the onset. @pre 0 ≤ load ≤ 1; rt-safe.
DetectionResponse respond(const SimulatedPerson& person, double load, Random& random) noexcept;

}  // namespace passung::person
