#pragma once

#include <string>

#include "study/store/rows/audit.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Deletes the participant with everything that hangs on them, frees their slot, leaves a tombstone in
/// the audit (see tombstone.h: the identity alone, no code) and writes the file anew, so that no byte of them remains
/// in it nor beside it. Needs room for a second copy, and nobody else may have the file open. For this room only:
/// throws. Returns the identity.
std::string eraseParticipant(const Database& database, const std::string& path, const std::string& participant,
                             const Actor& actor);

/// The same in the database's backup, where `identity` stands for them under this code or another; everything else in
/// it stays. False if there is no backup or if it does not hold them.
bool eraseFromBackup(const std::string& database_path, const std::string& identity, const Actor& actor);

}  // namespace passung::store
