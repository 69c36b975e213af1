#pragma once

#include <string>
#include <vector>

#include "study/measures/measures.h"
#include "study/plan/study_plan.h"
#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// Rows of a secondary task's stimuli and presses. For this room only: the functions throw.

/// `start_ns`: of the attempt.
void insertDetections(const Database& database, std::int64_t attempt_id, std::int64_t start_ns,
                      const std::vector<measures::Detection>& detections);

/// Reads by participant, session, trial, attempt, time.
std::vector<DetectionRow> readDetections(const Database& database);

}  // namespace passung::store
