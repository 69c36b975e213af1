#pragma once

#include "study/plan/study_plan.h"
#include "study/protocol/factors.h"
#include "study/protocol/scene_node.h"

namespace passung::protocol {

/// Reads [task] as its type declares it (trial_types.h). Sentences of errors name keys as the user wrote them. Without
/// a `scene` (nullptr: its parts are not known) it looks at what the table says by itself. The steps of an
/// assembly go into the scene.
plan::Task readTask(const StudyTables& tables, scene::SceneSpec* scene, Errors& errors);

/// Tells whether [task] has this key where its type is this one.
bool isTaskKey(const std::string& type, const std::string& key);

/// The scene of the other interval of a discrimination_pair: the condition's with the keys of task.comparison.
scene::SceneSpec readComparison(const StudyTables& tables, const plan::Condition& condition,
                                const SceneReading& reading, Errors& errors);

}  // namespace passung::protocol
