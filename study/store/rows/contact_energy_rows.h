#pragma once

#include <cstdint>
#include <vector>

#include "study/session/apparatus.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// Energy per obstacle of an attempt. For this room only: the functions throw.

void insertContactEnergy(const Database& database, std::int64_t attempt_id,
                         const std::vector<session::ContactEnergy>& pairs);

/// In the order of the scene; none in files older than revision 6, nor of attempts from before it.
std::vector<session::ContactEnergy> readContactEnergy(const Database& database, std::int64_t attempt_id);

}  // namespace passung::store
