#pragma once

#include <cstdint>
#include <optional>

#include "study/session/apparatus.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

// What of the condition's feedback reached the participant in an attempt. For this room only: the functions throw.

void insertDelivery(const Database& database, std::int64_t attempt_id, const session::Delivered& delivered);

/// None of attempts that did not end, nor of those from before it was stored.
std::optional<session::Delivered> readDelivery(const Database& database, std::int64_t attempt_id);

}  // namespace passung::store
