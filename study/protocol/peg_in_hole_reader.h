#pragma once

#include "core/scene/scene_spec.h"
#include "study/plan/task.h"
#include "study/protocol/factors.h"
#include "study/protocol/table_reader.h"

namespace passung::protocol {

/// Reads the keys of a peg_in_hole task. `target`: the part that it names, nullptr if that was reported already.
/// `units`: of the file's lengths in a metre. @pre what one key alone can have wrong was not found
plan::PegInHoleTask readPegInHole(const TableReader& read, const StudyTables& tables, const scene::SceneSpec& scene,
                                  const scene::PartSpec* target, const plan::Task& task, double units, Errors& errors);

}  // namespace passung::protocol
