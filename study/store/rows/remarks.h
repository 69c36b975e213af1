#pragma once

#include <cstdint>
#include <string>

namespace passung::store {

class Database;

// What people add to data that is there already; inside a transaction of the caller's.

/// The attempt no longer counts. Throws if it is not over or not valid as it is: the first reason stays.
void markInvalid(const Database& database, std::int64_t attempt_id, const std::string& reason);

struct Note {
    std::string session_id, t_utc, author, text;
};

void insertNote(const Database& database, const Note& note);

/// markInvalid() after the session's end, with an event for it.
void invalidateLater(const Database& database, std::int64_t attempt_id, const std::string& reason,
                     const std::string& now_utc);

/// A note about the newest session, or that of an attempt if `attempt_id` > 0. Simulated sessions get the time of their
/// end for `now_utc`, so that no wall clock reaches their data.
void noteLater(const Database& database, std::int64_t attempt_id, const std::string& text, const std::string& now_utc);

}  // namespace passung::store
