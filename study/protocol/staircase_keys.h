#pragma once

#include <array>

#include "study/protocol/key_ranges.h"
#include "study/protocol/key_table.h"

namespace passung::protocol::staircase_rows {

using enum KeyType;
using namespace ranges;

// Rows of the key table for staircases.
// clang-format off
inline constexpr std::array kStaircaseKeys{
    Key{"protocol", "staircase", Tables, kAny, "", "(none)", "Keys of the scene whose value follows, trial by trial, from what came before."},

    Key{"staircase", "name", Name, kAny, "", "!", "Name of the staircase, unique; a column of staircase.csv."},
    Key{"staircase", "block", Name, kAny, "", "!", "Main block whose trials the staircase governs; the staircase decides how many trials run. Every condition of the block has all tracks to itself."},
    Key{"staircase", "key", Text, kAny, "", "!", "Key that varies, as a factor's `key`; a number that is harder to notice, or easier to fail with, the lower it is."},
    Key{"staircase", "unit", Text, kAny, "", "(none)", "Unit of the levels, for tables."},
    Key{"staircase", "levels", Levels, kAny, "", "(low, high and count)", "Values that can be presented, ascending. Each value makes a condition that `check` examines."},
    Key{"staircase", "low", Number, kAny, "", "(levels)", "Lowest level, in place of `levels`."},
    Key{"staircase", "high", Number, kAny, "", "(levels)", "Highest level."},
    Key{"staircase", "count", Integer, from(2, 200), "", "(levels)", "Number of levels from low to high, evenly on the axis."},
    Key{"staircase", "logarithmic", Boolean, kAny, "", "false", "The axis is the logarithm of the level: steps and sigmas are decades."},
    Key{"staircase", "rule", Choice, kAny, "1_up_1_down|1_up_2_down|1_up_3_down|1_up_4_down|psi", "!", "n_down: a step down after n positive trials in a row, a step up after one that is not: settles where p^n = step_up / (step_up + step_down), with equal steps 50, 71, 79, 84 % positive. psi: the level that tells most of threshold and spread."},
    Key{"staircase", "step_down", Number, above(0), "", "(needed, but not by psi)", "Step down in levels, or decades."},
    Key{"staircase", "step_up", Number, above(0), "", "(as `step_down`)", "Step up; steps of two sizes weigh the answers."},
    Key{"staircase", "late_factor", Number, aboveUpTo(0, 1), "", "1", "Factor by which steps are smaller after `late_after` reversals."},
    Key{"staircase", "late_after", Integer, from(1, 1000), "", "2", "Number of reversals after which `late_factor` holds."},
    Key{"staircase", "max_trials", Integer, from(1, 1000), "", "40", "Number of trials after which a track stops."},
    Key{"staircase", "max_reversals", Integer, from(0, 1000), "", "0", "Number of reversals after which a track stops; 0: trials alone stop it."},
    Key{"staircase", "skip_reversals", Integer, from(0, 1000), "", "2", "Number of first reversals that the estimate, the mean of the others, leaves out."},
    Key{"staircase", "guess", Number, from(0, 0.99), "", "(needed by psi)", "Share of positive trials far below the threshold: 0.5 where one of two is chosen."},
    Key{"staircase", "lapse", Number, from(0, 0.5), "", "0.02", "Share of trials that are not positive far above the threshold; only psi."},
    Key{"staircase", "sigma_low", Number, above(0), "", "(needed by psi)", "Smallest standard deviation of the ogive that psi considers, in levels or decades."},
    Key{"staircase", "sigma_high", Number, above(0), "", "(needed by psi)", "Largest standard deviation that psi considers."},
    Key{"staircase", "tracks", Tables, kAny, "", "!", "Tracks that take turns at random, at least one."},
    Key{"staircase", "catch_share", Number, from(0, 0.5), "", "0", "Share of the trials that are catch trials: at `catch_level`, and no track is told of them."},
    Key{"staircase", "catch_level", Number, kAny, "", "(needed with catch_share)", "Level of catch trials: one of the staircase's."},
    Key{"staircase", "measure", Text, kAny, "", "!", "Measure of a trial by which it counts as positive; a trial without it tells its track nothing."},
    Key{"staircase", "above", Number, kAny, "", "(below)", "Bound of the measure in SI units, as exported; a trial above it is positive."},
    Key{"staircase", "below", Number, kAny, "", "(above)", "Bound of the measure in SI units, as exported; a trial below it is positive."},

    Key{"staircase_track", "name", Name, kAny, "", "!", "Name of the track, unique in the staircase."},
    Key{"staircase_track", "start", Number, kAny, "", "(needed, but not by psi)", "First level of the track."},
};
// clang-format on

}  // namespace passung::protocol::staircase_rows
