#pragma once

#include <string>
#include <vector>

#include "core/scene/scene_spec.h"
#include "study/feasible/path_problems.h"
#include "study/feasible/step_paths.h"

namespace passung::cli {

/// Conditions of one geometry, and what was found out for them.
struct GeometryGroup {
    std::vector<std::string> conditions;
    const scene::SceneSpec* scene = nullptr;
    std::vector<feasible::PathProblem> problems;
    std::vector<feasible::StepPath> paths = {};
};

/// Prints the conditions and the table's head.
void printHead(const GeometryGroup& group);
/// Prints the table's row of a path.
void printPath(const feasible::StepPath& path);
/// Prints a line for each [[task.step]] with a path: its `path_mm`. A scene without steps has none.
void printKeys(const GeometryGroup& group);

/// All that the table says and what is proven, in SI units; ends with a line's end. Equal paths give equal bytes but
/// for `search_s`.
std::string pathsJson(const std::vector<GeometryGroup>& groups);

}  // namespace passung::cli
