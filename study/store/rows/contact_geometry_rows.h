#pragma once

#include <string>
#include <vector>

#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// In the order of the conditions; none for a protocol that is not there. For this room only: throws.
std::vector<ContactGeometryRow> readContactGeometry(const Database& database, const std::string& protocol_sha256);

}  // namespace passung::store
