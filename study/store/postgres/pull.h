#pragma once

#include <string>

namespace passung::store {

/// Writes what PostgreSQL holds of the study of the database `like` into the new database `to`: the study's rows, and
/// the sessions that `like` has too; for restoreDatabase(). Throws.
void pullSessions(const std::string& from, const std::string& like, const std::string& to, const std::string& now_utc);

}  // namespace passung::store
