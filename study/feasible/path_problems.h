#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/scene/scene_spec.h"
#include "study/plan/study_plan.h"

namespace passung::feasible {

/// A part that stands still while a step is done.
struct StandingPart {
    std::size_t part = 0;  // its place in the scene
    Pose X_WP;
};

/// A step of a trial as a question: does a path lead from the start to the goal?
struct PathProblem {
    std::string name;      // of the step; of a peg_in_hole the part's
    std::size_t part = 0;  // that moves: its place in the scene
    Pose X_WStart, X_WGoal;
    std::vector<StandingPart> standing;
};

/// The steps of a condition in an order in which they may be done: of an assembly each of its steps, parts that are
/// not placed yet at their starts and those that are at their goals; of a peg_in_hole the way to the full depth, the
/// peg's frame along the target's. Of a goal that some turns about the part's z axis leave as it is (symmetry) that one
/// is taken which takes the least turn from the start. Empty: a trial of another type asks for no goal between parts.
std::vector<PathProblem> problemsOf(const plan::Condition& condition);

/// The same text for conditions whose problems are the same: parts, starts and goals, to the bit.
std::string geometryText(const scene::SceneSpec& scene, const std::vector<PathProblem>& problems);

}  // namespace passung::feasible
