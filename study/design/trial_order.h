#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "study/design/design.h"

namespace passung::design {

/// Participant and session that are planned for.
struct SessionKey {
    std::string_view study;        // name
    std::uint64_t seed = 0;        // of the study
    std::string_view participant;  // code
    std::size_t slot = 0;   // running number in the group, from 0: decides the rows of all counterbalancing factors
    std::size_t group = 0;  // index into groupsOf()
    int session = 1;        // of the participant, from 1
};

/// One trial of a session. Indices count from 0, repetitions from 1.
struct PlannedTrial {
    std::int64_t trial_index = 0;  // in the session
    std::int64_t block_index = 0;  // in the study
    std::string block;
    std::int64_t trial_in_block = 0;
    std::string phase;          // the block's, or "catch"
    std::size_t condition = 0;  // index into the study's conditions, the blocks' own ones after the shared
    int repetition = 1;         // pass of the block; in a Shuffled block: how often the condition came

    friend bool operator==(const PlannedTrial&, const PlannedTrial&) = default;
};

/// The trials of one participant's session in order. Pure: equal arguments give equal plans, with every compiler.
/// Counterbalanced blocks begin with the participant's row, the same in every block, and take another row in every
/// repetition, so that nobody gets an order twice before all rows are used; random ones draw from the stream
/// "trial_order" of (study, participant, block name), catch trials from "catch", so no draws move others. Constraints
/// hold among the trials that are no catch trials. Errors: no order was found that keeps to them.
/// @pre problemsOf(design) is empty
Result<std::vector<PlannedTrial>> planSession(const Design& design, const SessionKey& key);

/// Something that a study cannot be run with.
struct Problem {
    std::size_t block = 0;  // index
    const char* key = "";   // of the block: what to change
    std::size_t item = 0;   // with key "constraints": which
    std::string message;
};

/// Everything that makes blocks impossible: squares of too few or too many conditions, groups that see different
/// numbers of conditions, constraints that no order keeps to. Empty for a design that can be run.
std::vector<Problem> problemsOf(const Design& design);

/// How often plain shuffles keep to the block's constraints, of 1000; 1 without constraints. @pre as planSession
double acceptanceOf(const Design& design, std::size_t block);

}  // namespace passung::design
