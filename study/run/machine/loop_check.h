#pragma once

#include <string>

#include "core/loop/haptic_loop.h"

namespace passung::run {

/// What a loop is good for: studies; studies as long as nothing else runs, without real-time scheduling; trying out.
enum class LoopFitness { Studies, StudiesIfAlone, TryOuts, Nothing };

/// How well this machine keeps 1 kHz.
struct LoopCheck {
    loop::Scheduling scheduling;
    std::int64_t ticks = 0;
    std::int64_t missed = 0;                                 // cycles that did not happen in time
    double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;  // how late cycles began
    double compute_p99_us = 0;                               // of the tick itself
    LoopFitness fitness = LoopFitness::Nothing;
    std::string verdict;  // for a person
    bool fit = false;     // fit for a study with people
};

/// Runs the real loop with a small scene on the simulated device for `seconds`.
LoopCheck checkLoop(double seconds);

}  // namespace passung::run
