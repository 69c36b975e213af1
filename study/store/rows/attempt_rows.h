#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/store/rows/rows.h"

namespace passung::store {

class Database;

// For this room only: throws.

/// `{"factor": "label", …}` in the order in which it was written.
Levels readLevels(const Database& database, const std::string& levels_json);

/// All of them, by participant, session and trial, or `only` one.
std::vector<AttemptRow> readAttempts(const Database& database, std::optional<std::int64_t> only);

}  // namespace passung::store
