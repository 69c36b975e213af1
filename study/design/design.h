#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/design/constraints.h"

namespace passung::design {

enum class Order {
    Williams,      // row of a relabelled Williams square: balanced over participants
    Permutations,  // row of the list of all orders
    Random,        // a new seeded shuffle for every repetition
    Shuffled,      // all repetitions shuffled together
    Listed,        // 0 … n-1 as the protocol lists them
};

/// Whether everybody's row of a square or list decides the order.
inline bool isCounterbalanced(Order order) { return order == Order::Williams || order == Order::Permutations; }

enum class FactorKind {
    Within,    // everyone sees every level
    Between,   // a participant's group sees one
    Nuisance,  // its levels are assigned to the other conditions, another assignment for every row
};

struct FactorPlan {
    std::string name;  // unique in the study
    FactorKind kind = FactorKind::Within;
    std::size_t levels = 0;
};

struct ConditionPlan {
    std::vector<std::size_t> levels;  // one per factor
    bool catch_trial = false;         // only as a catch trial, never in a pass
};

/// Trials among those of a pass that nobody expects.
struct CatchPlan {
    std::size_t trials = 0;  // in every pass
    std::size_t from = 1;    // first position in the pass where one may stand, from 1
    std::size_t to = 0;      // last; 0: the last of the pass
};

/// What the order of a block depends on.
struct BlockPlan {
    std::string name;     // unique in the study
    std::string phase;    // handed through: "practice", "main"
    int repetitions = 1;  // passes through the order, ≥ 1
    Order order = Order::Williams;
    std::size_t trials = 0;                   // of each pass only the first so many; 0 = all conditions
    std::optional<std::size_t> blocked = {};  // factor whose levels come one after the other, all repetitions of each
    Order blocked_order = Order::Williams;
    std::vector<Constraint> constraints = {};  // of orders Random and Shuffled
    CatchPlan catches = {};
    int session = 1;                  // of the participant's sessions the one that has the block, from 1
    std::size_t first_condition = 0;  // > 0: the block has its own of each of its conditions, from this number on
    std::vector<std::size_t> conditions = {};  // that it has, in the order of Listed; empty: all
};

/// Tells whether the block has this condition, in a pass or as a catch trial.
bool hasCondition(const BlockPlan& block, std::size_t condition);

/// The number of the condition among all of the study, the blocks' own ones included. @pre the block has it
std::size_t numberIn(const BlockPlan& block, std::size_t condition);

/// A study's design: what orders, groups and slots follow from.
struct Design {
    std::vector<FactorPlan> factors;
    std::vector<ConditionPlan> conditions;
    std::vector<BlockPlan> blocks;
    int allocation_blocks = 1;  // a permuted block of the allocation holds each group so often
};

/// Something that takes turns over the participants. Row r of it goes to the slots whose digit is r, see rowOf().
struct CounterbalancingFactor {
    enum class What {
        Conditions,  // the order of a pass
        Levels,      // the order of a blocked factor's levels
        Assignment,  // which level of a nuisance factor goes with which condition
    };
    What what = What::Conditions;
    std::optional<std::size_t> factor;  // Levels, Assignment: which; Conditions: the one that the block is blocked by
    Order order = Order::Williams;
    std::size_t items = 0;

    friend bool operator==(const CounterbalancingFactor&, const CounterbalancingFactor&) = default;
};

std::size_t rowsOf(const CounterbalancingFactor& balancing);

/// Each once, in the order of the blocks that need them; assignments last.
std::vector<CounterbalancingFactor> counterbalancingFactorsOf(const Design& design);

/// How many slots show every combination of all counterbalancing factors' rows: their product.
std::size_t sequencesOf(const Design& design);

/// The row of counterbalancing factor `which` for a slot: mixed radix, the first counterbalancing factor turning
/// fastest. Never slot mod rows for each of them: rows with a common divisor would confound what they balance.
std::size_t rowOf(const std::vector<CounterbalancingFactor>& balancings, std::size_t which, std::size_t slot);

/// The combinations of levels of the between factors, in the order of the conditions; one empty one without such.
std::vector<std::vector<std::size_t>> groupsOf(const Design& design);

/// Permutation that stands for the numbers of a square, drawn once per study from the stream "relabel" of `phase`, so
/// that the square is random while its balance holds. The same for every participant.
std::vector<std::size_t> relabelling(std::size_t items, std::string_view study, std::string_view phase,
                                     std::uint64_t seed);

/// What one participant can be given, as indices into the conditions: those of the group, each with the nuisance
/// levels that the slot assigns to it.
struct Cells {
    std::vector<std::size_t> ordinary;
    std::vector<std::size_t> catches;
};
Cells cellsOf(const Design& design, std::size_t group, std::size_t slot, std::string_view study, std::uint64_t seed);

/// Those of the cells that the block has, in the order in which it lists its conditions.
Cells cellsOf(const BlockPlan& block, const Cells& cells);

/// `cells` parted by the levels of `factor`, levels ascending; one part without a factor.
std::vector<std::vector<std::size_t>> partedBy(const Design& design, std::optional<std::size_t> factor,
                                               const std::vector<std::size_t>& cells);

}  // namespace passung::design
