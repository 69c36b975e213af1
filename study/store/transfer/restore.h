#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/store/schema/open_options.h"

namespace passung::store {

/// What became of a damaged database.
struct RestoreReport {
    std::vector<std::string> healed;     // a line each
    std::vector<std::string> remaining;  // damages that the source could not heal
    std::vector<std::string> told;       // what else there is to know
    bool anew = false;                   // the file's pages were damaged: made anew from the source
    std::string kept;                    // then: where the damaged file lies now
};

/// Writes what the server `from` holds of the study of the database `like` into the new database `to`; throws.
using PullSessions = std::function<void(const std::string& from, const std::string& like, const std::string& to,
                                        const std::string& now_utc)>;

/// Is it the address of a PostgreSQL server: does it begin with postgresql:// or postgres://?
bool isServer(const std::string& from);

/// Heals the database `path` from an intact copy: another database of the study, a backup, or what was pushed into
/// PostgreSQL (isServer(), read by `pull`). Chunk by chunk, answer by answer: only what is damaged changes, and only
/// into what was once written there, by its hash. A file whose pages are damaged is made anew from the source, with
/// what is intact in it and newer and without whom it says were erased; that takes a file for a source. Nothing
/// replaces a file whose pages are sound. The database changes as a whole or not at all.
/// @pre `pull`, if `from` is a server
Result<RestoreReport> restoreDatabase(const std::string& path, const std::string& from, const OpenOptions& options,
                                      const PullSessions& pull = {});

}  // namespace passung::store
