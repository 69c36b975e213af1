#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/plan/staircase.h"
#include "study/plan/study_plan.h"
#include "study/protocol/document.h"
#include "study/protocol/factors.h"

namespace passung::protocol {

/// A staircase as written, with what its levels put into the scene.
struct StaircaseContent {
    plan::Staircase staircase;
    TextPosition key_place, measure_place;
    std::vector<Node> values;  // a number for each level, placed where it is written

    /// What level number `level` changes.
    Override change(std::size_t level) const { return {staircase.key, key_place, &values[level]}; }
};

/// Reads the [[staircase]] tables by the plan's blocks, which it tells how many trials they have. `block_tables`: the
/// blocks' own. Errors: also a key that a factor or the block changes too.
std::vector<StaircaseContent> readStaircases(const std::vector<Node>& tables, const std::vector<Node>& block_tables,
                                             const std::vector<FactorContent>& factors,
                                             std::span<const std::string> known_measures,
                                             std::vector<plan::Block>& blocks, Errors& errors);

}  // namespace passung::protocol
