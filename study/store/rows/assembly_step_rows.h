#pragma once

#include <cstdint>
#include <vector>

#include "study/session/trial_sink.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// What became of the steps of an attempt at an assembly. For this room only: the functions throw.

void insertAssemblySteps(const Database& database, std::int64_t attempt_id, const std::vector<session::StepEnd>& steps);

/// In the order of the protocol; none in files older than revision 20.
std::vector<session::StepEnd> readAssemblySteps(const Database& database, std::int64_t attempt_id);

}  // namespace passung::store
