#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/import/mesh_import.h"

namespace passung::run {

/// What reading one mesh file may take.
struct ImportLimits {
    double processor_s = 20.0;
    std::uintmax_t memory = std::uintmax_t{1} << 30;  // [bytes]; or 16 times the file, if that is more
};

/// The program passung-import, which stands beside this one; nothing if there is none (a program of somebody else).
std::optional<std::filesystem::path> importProgram();

/// importer::importMesh() in a program of its own, within the limits: whatever the file does to it, this one gets a
/// mesh or one error. The same mesh and report, bit for bit.
Result<importer::ImportedMesh> importElsewhere(const std::filesystem::path& program, const std::string& path,
                                               double metres_per_unit, const ImportLimits& limits);

}  // namespace passung::run
