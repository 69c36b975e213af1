#pragma once

#include <string>
#include <vector>

#include "analysis/export/export.h"
#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// The protocols, and the files that they name as far as the database holds them, placed as the protocols name them
/// where that stays in the folder, so that `passung check` reads the exported protocol.
std::vector<ExportedFile> namedFiles(const StudyData& study);

/// One row per file that a protocol names.
Table makeFiles(const StudyData& study);

}  // namespace passung::exporter
