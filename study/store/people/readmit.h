#pragma once

#include <string>

#include "study/store/rows/audit.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Takes an exclusion back: data and status are as before, and the slot too unless somebody else has it
/// by now. Returns whether it has. Throws for somebody who is not excluded, or who asked for it. For this room only.
bool readmit(const Database& database, const Actor& actor, const std::string& code, const std::string& reason);

/// What an exclusion takes away, for its row in the audit: the status and the place that the participant has now.
void describeStanding(const Database& database, const std::string& code, JsonObject& detail);

}  // namespace passung::store
