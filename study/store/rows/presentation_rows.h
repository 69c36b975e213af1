#pragma once

#include <cstdint>
#include <optional>

#include "study/session/apparatus.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// What a window gave the participant in an attempt. For this room only: the functions throw.

void insertPresentation(const Database& database, std::int64_t attempt_id, const session::Presentation& given);

/// None of attempts that no window showed.
std::optional<session::Presentation> readPresentation(const Database& database, std::int64_t attempt_id);

}  // namespace passung::store
