#pragma once

#include <string>
#include <vector>

#include "analysis/export/study_data.h"
#include "analysis/export/table.h"

namespace passung::exporter {

/// A file that a protocol names, with its place in the export.
struct ExportedFile {
    std::string path;
    std::string bytes;
};

/// The protocols, and the files that they name as far as the database holds them, placed as the protocols name them
/// where that stays in the folder, so that `passung check` reads the exported protocol.
std::vector<ExportedFile> namedFiles(const StudyData& study);

/// One row per file that a protocol names.
Table makeFiles(const StudyData& study);

}  // namespace passung::exporter
