#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/design/design.h"

namespace passung::plan {

enum class Phase { Practice, Main };
const char* phaseName(Phase phase);                        // "practice", "main": as stored
inline constexpr const char* kAdaptivePhase = "adaptive";  // of the trials of a staircase, as stored

using BlockOrder = design::Order;
const char* blockOrderName(BlockOrder order);  // "williams", "permutations", "random", "shuffled", "listed"

enum class Repeat { Never, Now, AtBlockEnd };

/// Person or clock that ends a rest which has lasted long enough.
enum class RestEnds { ByTime, ByParticipant, ByExperimenter };
const char* restEndsName(RestEnds ends);  // "time", "participant", "experimenter"

struct Block {
    std::string name;
    Phase phase = Phase::Main;
    int repetitions = 1;  // passes through the order
    BlockOrder order = BlockOrder::Williams;
    int trials = 0;                           // 0 = every condition of the pass; else the first so many (practice)
    std::optional<std::size_t> blocked = {};  // factor whose levels come one after the other
    BlockOrder blocked_order = BlockOrder::Williams;
    std::vector<design::Constraint> constraints = {};
    design::CatchPlan catches = {};
    int session = 1;    // of each participant's, from 1
    double rest = 0.0;  // [s] at least so long is rested before it
    RestEnds rest_ends = RestEnds::ByTime;
    bool adaptive = false;              // a staircase governs its trials
    std::size_t first_condition = 0;    // its own conditions begin here, parallel to those that it has of the shared
                                        // ones; 0: it takes those
    Repeat on_failure = Repeat::Never;  // of a trial that ended by its own rules without success
    Repeat on_timeout = Repeat::Never;
    Repeat on_invalid = Repeat::Never;  // of a trial whose attempt does not count
    int max_attempts = 3;               // of a trial, however they end
    /// Shared conditions that the block has, as it lists them, those of its catch trials last; empty: all.
    std::vector<std::size_t> conditions = {};
};

}  // namespace passung::plan
