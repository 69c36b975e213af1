#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "study/store/schema/sqlite.h"

namespace passung::store {

// What was said about a session, then or later: notes, events, attempts that do not count. Files of one session can
// each have some of it, and none may be lost when they are put together. For this room only: the functions throw.

struct SessionRemarks {
    using Text = std::optional<std::string>;
    using AttemptKey = std::pair<std::int64_t, std::int64_t>;  // trial_index, attempt_no

    std::set<std::tuple<std::string, Text, std::string>> notes;  // t_utc, author, text
    /// segment from 0, attempt, t_ns, source, event, payload, t_utc
    std::set<std::tuple<std::int64_t, std::optional<AttemptKey>, std::int64_t, std::string, std::string, Text, Text>>
        events;
    std::map<AttemptKey, std::string> invalid;  // with the reason
};

/// Of the session in the attached database `schema`, whatever numbers its rows have there.
SessionRemarks remarksOf(const Database& database, const std::string& schema, const std::string& session_id);

/// What came of uniting.
struct UnitedRemarks {
    bool changed = false;
    std::vector<std::string> conflicts;  // attempts that do not count for two reasons: "trial 4, attempt 1: …"
};

/// Adds what the session in the main database does not have; an attempt that does not count in one of them counts in
/// neither, and the first reason stays.
UnitedRemarks uniteRemarks(const Database& database, const std::string& session_id, const SessionRemarks& more);

}  // namespace passung::store
