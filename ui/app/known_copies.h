#pragma once

#include <string>
#include <vector>

namespace passung::app {

/// Copies of a participant's data that can be seen from the database: its backup and checksum, and the exports in
/// folders beside it that name the participant. Sorted; other copies nobody knows.
std::vector<std::string> knownCopies(const std::string& database, const std::string& participant);

}  // namespace passung::app
