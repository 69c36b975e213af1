#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/design/adaptive.h"

namespace passung::plan {

struct StudyPlan;

/// One of the tracks of a staircase that take turns.
struct StaircaseTrack {
    std::string name;  // unique in the staircase
    design::AdaptiveParams params;
};

/// One key of the scene whose value is chosen trial by trial from what came before. It governs all trials of one block;
/// every condition of the block has all its tracks to itself. A trial counts for its track as positive or not by a
/// measure; the higher the level, the more often that should be.
struct Staircase {
    std::string name;  // unique
    std::size_t block = 0;
    std::string key;             // as a factor's
    std::string unit;            // of the levels; may be empty
    std::vector<double> levels;  // ascending: what can be presented
    std::vector<StaircaseTrack> tracks;
    std::size_t catch_trials = 0;  // of every condition: at catch_level, and no track is told of them
    double catch_level = 0.0;      // one of levels
    std::string measure;
    double threshold = 0.0;  // of the measure
    bool above = true;       // positive: the measure is above the threshold; else: below it
    /// Of a pair whose comparison the key changes, judged by `correct`: what the key is in the other interval. Empty
    /// for others, where the protocol does not write it, or where conditions differ in it.
    std::optional<double> reference = {};
    /// Index of the plan's condition that presents the first level in place of condition i of those that the block has;
    /// the others follow.
    std::vector<std::size_t> first_variant;

    /// Trials of every condition: as many as all tracks may need, and the catch trials.
    std::size_t trials() const;
};

/// The staircase of a block; nullptr if it has none.
const Staircase* staircaseOf(const StudyPlan& plan, std::size_t block);

/// Index of the condition that presents level number `level` in place of the planned one. @pre the condition is the
/// block's
std::size_t variantOf(const StudyPlan& plan, const Staircase& staircase, std::size_t condition, std::size_t level);

}  // namespace passung::plan
