#pragma once

#include <string>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// What ties rows to one another, healed before the rows themselves. For this room only: the functions throw and return
// what they healed, a line each. @pre in a transaction whose foreign keys are deferred

/// A row whose parent is none gets the one that the same row has in the attached database `source`.
std::vector<std::string> healReferences(const Database& database, const std::string& source);

/// A kept hash of a row of the study (row_hash.h) whose name is damaged is filed under the row that it fits.
std::vector<std::string> healHashNames(const Database& database);

}  // namespace passung::store
