#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "study/session/trial_sink.h"
#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

/// `utc`: by the wall clock; none in virtual time. @pre in a transaction
void insertEvent(const Database& database, std::int64_t segment_id, const session::Event& event,
                 const std::optional<std::string>& utc);

/// Hands out the events by participant and session, in the order of time.
void eachEvent(const Database& database, const std::function<void(const EventRow&)>& take);

}  // namespace passung::store
