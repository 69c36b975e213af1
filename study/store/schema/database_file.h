#pragma once

#include <string>

namespace passung::store {

/// Tells whether a regular file begins as SQLite's databases do. Also if a few of its first 16 bytes, which all share,
/// are damaged: half are enough.
bool beginsAsDatabase(const std::string& path);

}  // namespace passung::store
