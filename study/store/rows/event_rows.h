#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/session/trial_sink.h"
#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

/// UTC of event `e` of segment `g` by the session's epoch, in SQL. Only virtual time and older programs stored none.
inline constexpr const char* kEventUtc =
    "coalesce(e.t_utc, strftime('%Y-%m-%dT%H:%M:%fZ', g.utc_zero, printf('+%.9f seconds', e.t_ns * 1e-9)))";

/// `utc`: by the wall clock; none in virtual time. @pre in a transaction
void insertEvent(const Database& database, std::int64_t segment_id, const session::Event& event,
                 const std::optional<std::string>& utc);

/// Reads the events by participant and session, in the order of time.
std::vector<EventRow> readEvents(const Database& database);

}  // namespace passung::store
