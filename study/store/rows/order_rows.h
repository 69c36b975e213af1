#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "study/session/trial_sink.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// For this room only: the functions throw.

/// Steps that the session takes in this segment. @pre in a transaction
void insertOrderSteps(const Database& database, const std::string& session_id, std::int64_t segment_id,
                      std::span<const session::OrderStep> steps);

/// All of a session, in time.
std::vector<session::OrderStep> readOrderSteps(const Database& database, const std::string& session_id);

}  // namespace passung::store
