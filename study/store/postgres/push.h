#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace passung::store {

/// What a push did.
struct PushReport {
    std::int64_t sessions = 0;             // added
    std::int64_t replaced = 0;             // had changed here since an earlier push
    std::int64_t known = 0;                // there already
    std::int64_t healed = 0;               // were damaged there
    std::vector<std::string> damaged;      // not pushed, for they are damaged here: "S001, session 1, trial 4 …: …"
    std::vector<std::string> newer_there;  // not pushed: sessions and codes of which it has rows that this file lacks
    std::vector<std::string> unfinished;   // left out: still running, or killed and not opened since
    std::vector<std::string> erased_there;   // codes: were erased here, and now there too
    std::vector<std::string> left_out;       // codes: were erased there, from another file
    std::vector<std::string> shared_places;  // codes that have one slot: "P001, P101"
};

/// Copies the study into the PostgreSQL database `to` (a connection URI or string of libpq), into a schema with the
/// study's name that is made if it is not there. Tables are those of the file; rows of a session carry its session_id
/// and are numbered within it, so that files of several stations do not collide. Each session is one transaction;
/// pushing again copies only what is new or has changed, never an older copy over a newer one, and places and people
/// that are gone here are gone there. What is damaged here does not travel. Of what is damaged there, sessions, people
/// and places are replaced by what is intact here; other rows of the study that are there already stay as they are.
/// Refused is what mergeDatabases() refuses, and a damaged audit. Free slots stay here.
Result<PushReport> pushDatabase(const std::string& path, const std::string& to);

}  // namespace passung::store
