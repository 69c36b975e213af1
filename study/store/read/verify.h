#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::store {

/// Findings of a check of every hash, checksum and page of a database.
struct Verification {
    std::vector<std::string> damages;     // a line each: "S001, session 1, trial 4, attempt 1, samples: …"
    std::vector<std::string> not_hashed;  // what has no hashes to compare: "S001, session 1"
    std::int64_t sessions = 0, chunks = 0, rows = 0;
};

/// Compares a study's database with what was once written into it: SQLite's own check of every page and index, the
/// hashes of the study's rows and of every session's values, the checksum of every chunk of samples, the chains of the
/// audit. Fails only for what is no database of this program.
Result<Verification> verifyDatabase(const std::string& path);

}  // namespace passung::store
