#pragma once

#include <string>
#include <vector>

namespace passung::run {

// Exports that this user made, in the file `exports` of dataFolder(): the database stays as it is, wherever it lies.
// Other users' exports nobody knows.

/// False if it cannot be kept.
bool rememberExport(const std::string& database, const std::string& folder);

/// Folders of exports of the database, and of databases that are gone, which may have been this one under another name.
/// Sorted; folders that are gone are left out.
std::vector<std::string> knownExports(const std::string& database);

}  // namespace passung::run
