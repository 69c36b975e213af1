#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace passung::design {

enum class Order {
    Williams,  // row of a relabelled Williams square: balanced over participants
    Random,    // a new seeded shuffle for every repetition
    Listed,    // 0 … n-1 as the protocol lists them
};

/// What the order of a block depends on.
struct BlockPlan {
    std::string name;     // unique in the study
    std::string phase;    // handed through: "practice", "main"
    int repetitions = 1;  // passes through the order, ≥ 1
    Order order = Order::Williams;
    std::size_t trials = 0;  // of each pass only the first so many; 0 = all conditions
};

/// Who is planned for.
struct SessionKey {
    std::string_view study;        // name
    std::uint64_t seed = 0;        // of the study
    std::string_view participant;  // code
    std::size_t slot = 0;          // running number in the study, from 0: decides the row of the square
};

/// One trial of a session. Indices count from 0, repetitions from 1.
struct PlannedTrial {
    std::int64_t trial_index = 0;  // in the session
    std::int64_t block_index = 0;
    std::string block;
    std::int64_t trial_in_block = 0;
    std::string phase;
    std::size_t condition = 0;  // index into the study's conditions
    int repetition = 1;         // pass of the block

    friend bool operator==(const PlannedTrial&, const PlannedTrial&) = default;
};

/// Which condition stands for which number of the square: a permutation drawn once per study (stream "relabel"), so
/// that the square is random while its balance holds. The same for every participant.
std::vector<std::size_t> conditionLabels(std::size_t conditions, std::string_view study, std::uint64_t seed);

/// The trials of one participant in order. Pure: equal arguments give equal plans, with every compiler.
/// Williams blocks repeat the participant's row in every repetition and every block; Random blocks draw from the stream
/// "trial_order" of (study, participant, block name), so no block's draws depend on another's.
/// @pre conditions ≥ 1, and ≥ 2 with a Williams block.
std::vector<PlannedTrial> planSession(std::size_t conditions, const std::vector<BlockPlan>& blocks,
                                      const SessionKey& key);

}  // namespace passung::design
