#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "study/session/staircase_step.h"
#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

/// What an attempt that begins presents. @pre in a transaction
void insertStaircaseStep(const Database& database, const std::string& session_id, std::int64_t attempt_id,
                         const session::StaircaseStep& step);

/// What came of it. @pre in the transaction that ends the attempt
void storeStaircaseAnswer(const Database& database, std::int64_t attempt_id, const session::StaircaseAnswer& answer);

/// Reads staircases by protocol, as it lists them.
std::vector<StaircaseTrackRow> readStaircaseTracks(const Database& database);

/// Reads steps by attempt.
std::vector<StaircaseStepRow> readStaircaseSteps(const Database& database);

}  // namespace passung::store
