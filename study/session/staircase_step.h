#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace passung::session {

/// What a staircase has a trial present.
struct StaircaseStep {
    std::string staircase;
    std::string track;          // empty: a catch trial
    double wanted = 0.0;        // by the track's rule, before it is rounded to what can be presented
    double level = 0.0;         // what is presented
    std::size_t condition = 0;  // index of the plan's condition that presents it
};

/// What came of it.
struct StaircaseAnswer {
    std::optional<bool> positive;     // none: the trial has no answer, or does not count
    bool reversal = false;            // of the track's direction
    std::optional<double> estimate;   // of the track's threshold after it
    std::optional<double> deviation;  // psi: posterior standard deviation, in levels or decades
};

}  // namespace passung::session
