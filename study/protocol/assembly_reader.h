#pragma once

#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads the [task] of type assembly. Its steps go into the scene, effects.pick.steps.
/// @pre the keys of `read` are sound
plan::AssemblyTask readAssembly(const TableReader& read, const StudyTables& tables, double units,
                                scene::SceneSpec& scene, Errors& errors);

}  // namespace passung::protocol
