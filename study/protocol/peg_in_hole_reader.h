#pragma once

#include <string>

#include "study/protocol/factors.h"
#include "study/protocol/study_plan.h"

namespace passung::protocol {

/// Reads [task] and checks that it can be done in `condition.scene`, which must be sound. `tables` are those of the
/// condition: what does not fit is reported where it is written.
PegInHoleTask readTask(const StudyTables& tables, const model::SceneSpec& scene, Errors& errors);

}  // namespace passung::protocol
