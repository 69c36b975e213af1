#pragma once

#include <vector>

#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// Notes and experimenters' commands by participant and session, then in time. For this room only: it throws.
std::vector<NoteRow> readNotes(const Database& database);

}  // namespace passung::store
