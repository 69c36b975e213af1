#pragma once

#include <string>
#include <vector>

namespace passung::run {

/// Copies of a participant's data that can be seen from the database: its backup, and the exports that name the
/// participant, in folders beside it and wherever this user made them. Sorted, with whole paths; other copies nobody
/// knows.
std::vector<std::string> knownCopies(const std::string& database, const std::string& participant);

}  // namespace passung::run
