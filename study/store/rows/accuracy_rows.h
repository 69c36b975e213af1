#pragma once

#include <vector>

#include "study/store/rows/rows.h"
#include "study/store/schema/sqlite.h"

namespace passung::store {

/// All candidates with what they were picked for, by protocol hash, then candidate; none in files older than
/// revision 2. For this room only, as the next: throws.
std::vector<AccuracyRow> readAccuracy(const Database& database);

/// Inserts them, in one transaction. A protocol that has candidates already throws.
void insertAccuracy(const Database& database, const std::vector<AccuracyRow>& rows);

}  // namespace passung::store
