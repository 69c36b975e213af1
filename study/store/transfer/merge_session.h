#pragma once

#include <string>
#include <vector>

#include "study/store/schema/session_tables.h"

namespace passung::store {

/// Tells whether the session in the attached database `other` has anything that it has not in `one`, remarks apart. For
/// this room only, as below: throws.
bool sessionLacks(const Database& database, const std::string& one, const std::string& other, const std::string& id);

/// Copies a session with all that belongs to it from the attached database `source` into the main one, under numbers
/// that are free there. @pre it is not there, its conditions are
void copySession(const Database& database, const std::vector<SessionTable>& tables, const std::string& source,
                 const std::string& id);

}  // namespace passung::store
