#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/types.h"

namespace passung::scene {

struct SceneSpec;

/// Steps of an assembly as a set of bits, step 0 the lowest.
using StepSet = std::uint64_t;
inline constexpr std::size_t kMostSteps = 63;
constexpr StepSet stepBit(std::size_t step) noexcept { return StepSet{1} << step; }

/// A step of an assembly: a part belongs at a goal, after other steps. Done when the part is let go there
/// (core/tick/pick.h).
struct AssemblyStep {
    std::size_t part = 0;              // its place in the scene; pickable
    std::size_t into = kWorld;         // the part whose frame the goal is in, where that part then is
    Pose X_IGoal;                      // the part in that frame
    double position_tolerance = 1e-3;  // [m], of the part's origin, > 0
    double angle_tolerance = 0.1;      // [rad], > 0
    int folds = 1;      // turned about its z axis by a full turn / folds the part is as before, ≥ 1; 0: by any angle
    StepSet after = 0;  // done before
    bool locks = true;  // the part stays there for good, or until it is undone
    static constexpr std::size_t kWorld = ~std::size_t{0};
};

/// How far a part is from where it belongs.
struct GoalError {
    double position = 0.0;  // [m], of its origin
    double angle = 0.0;     // [rad], 0 … π: the least over the turns about its z axis that make no difference
};
/// `folds` as in AssemblyStep. rt-safe.
GoalError goalError(const Pose& X_WP, const Pose& X_WGoal, int folds) noexcept;

/// Of the poses that a turn about the goal's z axis makes like `X_WGoal` the one that a part at `X_WP` needs the least
/// turn to. rt-safe.
Pose nearestGoal(const Pose& X_WP, const Pose& X_WGoal, int folds) noexcept;

/// Where the step's part belongs now. `X_WP`: of every part of the scene. rt-safe.
Pose goalOf(const AssemblyStep& step, std::span<const Pose> X_WP) noexcept;

/// The part is there, within both tolerances. rt-safe.
bool isAtGoal(const AssemblyStep& step, std::span<const Pose> X_WP) noexcept;

/// An order in which each step comes after those that it is after: of several that may be next the first one. Shorter
/// than `steps` if some wait for each other: those are missing.
std::vector<std::size_t> orderOf(std::span<const AssemblyStep> steps);

/// What is wrong with a step, in words that fit its key: "after", "part", "into", "position_tolerance" ...
struct StepProblem {
    std::size_t step = 0;
    std::string_view key;
    std::string message;
};
/// Of values alone; whether parts overlap where they belong is for geometry to say.
std::vector<StepProblem> problemsOf(std::span<const AssemblyStep> steps, const SceneSpec& spec);

}  // namespace passung::scene
