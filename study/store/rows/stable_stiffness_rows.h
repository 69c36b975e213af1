#pragma once

#include <string>
#include <vector>

#include "study/plan/study_plan.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// By device; none in files older than revision 4, nor for protocols from before it. For this room only: throws.
std::vector<plan::StableStiffness> readStableStiffness(const Database& database, const std::string& protocol_sha256);

}  // namespace passung::store
