#pragma once

#include <string>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Gives the people of the attached database `source` their slots in the main one. Everybody keeps their
/// row of the square; where stations gave one place twice, the second takes the same row in a further replicate and is
/// returned; whoever is left out (tombstone.h) keeps what they have. For this room only: throws. @pre in a transaction
std::vector<std::string> mergePlaces(const Database& database);

}  // namespace passung::store
