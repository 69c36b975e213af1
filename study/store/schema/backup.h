#pragma once

#include <functional>
#include <string>

namespace passung::store {

class Database;

/// Path of a database's copy: beside the database (links resolved), with `.backup` after its name; its SHA-256 in
/// `<backup>.sha256`, as sha256sum writes and checks it. To go back to it, copy it over the database.
std::string backupPath(const std::string& database_path);

/// Writes the copy and its SHA-256, each complete or not at all; without the second the first may be older than the
/// database. `change` gets the new copy before it takes the place of the old one. For this room only: throws.
void writeBackup(const Database& database, const std::string& database_path,
                 const std::function<void(Database& copy, const std::string& path)>& change = {});

}  // namespace passung::store
