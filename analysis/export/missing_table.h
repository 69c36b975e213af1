#pragma once

#include "analysis/export/table.h"
#include "study/store/rows/rows.h"

namespace passung::exporter {

inline constexpr const char* kMissingFile = "missing.csv";

/// What is damaged in the database and so is not in the export.
Table makeMissing(const std::vector<store::DamageRow>& damages);

}  // namespace passung::exporter
