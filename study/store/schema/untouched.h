#pragma once

#include <memory>
#include <string>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// How a database is read so that no byte of it changes, wherever it lies. For this room only: the functions throw.

/// A connection that reads. Where this user may write the file, SQLite's side files come and go with it as for anybody
/// else, so that a session can begin meanwhile; what a killed program left in them stays there. Elsewhere (an archive
/// on a medium that cannot be written, another user's folder) none is made; there the file must not be written while
/// it is read, and is not read while a session runs that this user cannot follow. What a killed program left there is
/// taken in in a private copy.
std::unique_ptr<Database> openUntouched(const std::string& path);

/// Tells whether SQLite leaves the file as it is where a connection that writes another one attaches it: not if it
/// holds a log or a journal, and not at all where this user may not write.
bool staysUntouched(const std::string& path);

/// The same data in a file of our own, which goes with the connection and may be written.
std::unique_ptr<Database> privateCopy(const Database& database, const std::string& path);

}  // namespace passung::store
