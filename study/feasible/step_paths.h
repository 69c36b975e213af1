#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/truth/exact_overlap.h"
#include "core/base/result.h"
#include "core/path/path_measures.h"
#include "core/scene/scene.h"
#include "study/feasible/path_problems.h"

namespace passung::feasible {

/// What was found out of a step.
struct StepPath {
    std::string name;  // of the problem
    std::string part;  // that moves
    bool found = false;
    std::string why;                // none was found, in words
    bool is_proof = false;          // there is none: an end overlaps
    std::vector<Pose> poses;        // from start to goal, straight between them
    path::PathMeasures measures{};  // of it; nothing is proven of closed forms
    std::string nearest;            // part that it comes nearest to
    double seconds = 0.0;
};

struct Settings {
    double seconds = 30.0;   // of each step's search, > 0
    std::uint32_t seed = 1;  // > 0
};

/// To be called once, before the first search of the program.
void seed(const Settings& settings);

/// What is made of parts is kept in `cache` and `bodies`, from step to step. Errors: a part that cannot be built, as
/// scene::buildPart.
Result<StepPath> pathOf(const scene::SceneSpec& scene, const PathProblem& problem, scene::PartCache& cache,
                        truth::OverlapBodies& bodies, const Settings& settings);

/// Overlaps up to this are contact [m]: triangles of shapes are 1 µm off the true surface at most.
inline constexpr double kTouch = 2e-6;

}  // namespace passung::feasible
