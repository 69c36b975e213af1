#pragma once

#include <cstdint>
#include <vector>

#include "study/measures/measures.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// True overlaps of an attempt's judged ticks. For this room only: the functions throw.

void insertExactOverlaps(const Database& database, std::int64_t attempt_id,
                         const std::vector<measures::TickOverlap>& overlaps);

/// By tick; none in files older than revision 17, nor of attempts from before it.
std::vector<measures::TickOverlap> readExactOverlaps(const Database& database, std::int64_t attempt_id);

}  // namespace passung::store
