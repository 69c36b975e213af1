#pragma once

#include <string>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// The statements that SQLite keeps of a file's tables and indices. A bit that flips in them changes no page's form, and
// so SQLite's own check says nothing. For this room only: the functions throw.

/// What of the schema is not as this program wrote it, or an older one: "the schema's text of table session", "the
/// schema's number 31" (of its last revision). Empty for
/// a file of somebody else, of a newer program, or whose list of tables cannot be read at all. Objects that others
/// added are none.
std::vector<std::string> schemaFaults(const Database& database);

/// Writes that text again as it was. Returns what it mended, as schemaFaults names it. @pre the file is nobody else's
std::vector<std::string> mendSchema(const Database& database);

}  // namespace passung::store
