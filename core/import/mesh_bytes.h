#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/import/mesh_import.h"

namespace passung::importer {

/// What importMesh() answered, as bytes for another process.
std::string toBytes(const Result<ImportedMesh>& imported);

/// The answer that the bytes hold. Its writer is not trusted: nothing comes back if a number of items does not fit the
/// bytes, a vertex is not finite, a triangle names none, or something is missing or left over.
std::optional<Result<ImportedMesh>> importedFrom(std::string_view bytes);

}  // namespace passung::importer
