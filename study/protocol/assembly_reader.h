#pragma once

#include <span>

#include "core/base/device_description.h"
#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/part_surface.h"
#include "study/protocol/scene_node.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads the [task] of type assembly. Its steps go into the scene, effects.pick.steps.
/// @pre the keys of `read` are sound
plan::AssemblyTask readAssembly(const TableReader& read, const StudyTables& tables, double units,
                                scene::SceneSpec& scene, Errors& errors);

/// Adds an error for every step whose part cannot be there: its goal is out of the hands' reach, or overlaps a part
/// that rests, or another step's at its goal; or who goes by what is drawn misses it. To `warnings` a sentence for each
/// goal where another part starts that need not have left by then. @pre the condition's trial is an assembly
void checkAssembly(const StudyTables& tables, const plan::Condition& condition,
                   std::span<const DeviceDescription> devices, PartGeometries& geometries, Errors& errors,
                   std::vector<std::string>& warnings);

}  // namespace passung::protocol
