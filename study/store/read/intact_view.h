#pragma once

#include <string>
#include <vector>

#include "study/store/read/session_damage.h"
#include "study/store/rows/rows.h"

namespace passung::store {

/// Puts views before the tables of a connection, so that whoever reads it meets nothing that is damaged: sessions,
/// attempts, forms, events, notes, chunks of samples, people. Returns what was left out, and what of the study's own
/// rows is damaged and read as it stands. For this room only: throws.
std::vector<DamageRow> leaveOutDamaged(const Database& database, SampleCheck samples);

}  // namespace passung::store
