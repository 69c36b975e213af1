#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/random.h"

namespace passung::person {

/// How a simulated person notices what a staircase varies: a normal ogive of the level x that was really presented, on
/// the staircase's axis (the level, or its logarithm to the base 10). Proposed here; it shows that procedure and
/// estimate work, and says nothing about people.
struct Perception {
    double threshold = 0.0;  // on the axis: the ogive's middle
    double sigma = 1.0;      // on the axis: its standard deviation
    double lapse = 0.02;     // share of trials without attention

    /// Chance of a positive answer: guess + (1 - guess - lapse) Phi((x - threshold) / sigma). `guess`: what chance
    /// gives far below the threshold: 1/2 where one of two is chosen.
    double chance(double x, double guess) const;
};

/// The perception of the simulated participant `code` for a staircase whose axis goes from `low` to `high`: with the
/// width w = high - low and one normal number each, threshold low + w (0.5 + 0.1 normal), kept in the middle three
/// fifths; sigma w 0.08 exp(0.25 normal); lapse 0.02 exp(0.5 normal), at most 0.06. The same in all trials and
/// sessions.
Perception perceptionOf(std::string_view study, std::string_view code, std::uint64_t study_seed,
                        std::string_view staircase, double low, double high);

/// One answer, positive or not.
bool perceives(const Perception& perception, double x, double guess, Random& random);

}  // namespace passung::person
