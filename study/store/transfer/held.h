#pragma once

#include <string>
#include <vector>

#include "study/store/schema/row_hash.h"

namespace passung::store {

// Damage in a source is no loss where the main database has what was once written there. For this room only: what
// cannot be read in the source, attached as `source`, is not held; the functions throw where the disk fails.

/// Is the session in the main database as it was kept in the source, with what people changed in it since?
bool holdsSession(const Database& database, const std::string& source, const std::string& session);

/// Is the damaged row of the source sound in the main database, whose own `faults` are these, with all sessions of whom
/// it is about?
bool holdsRow(const Database& database, const std::string& source, const RowFault& fault,
              const std::vector<RowFault>& faults);

}  // namespace passung::store
