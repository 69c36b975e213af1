#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/run_choice.h"
#include "study/store/rows/picture_rows.h"
#include "study/store/schema/open_options.h"

namespace passung::store {

class Database;

// A protocol with everything that hangs on it. For this room only: whatever touches the database throws.

struct MeshContent {
    std::string mesh, sha256;
    std::int64_t bytes;
};

/// The plan's mesh files. Errors: one that cannot be read.
Result<std::vector<MeshContent>> readMeshes(const plan::StudyPlan& plan);

/// Rows of the square and everybody's order follow from the seed: one protocol has one seed in a database.
void requireSeed(const Database& database, const std::string& sha256, std::uint64_t seed);

/// Measures belong to the whole file: one formula per name, or the numbers of one column would mean two things. Those
/// that the file does not know yet, from before this program had them, are added. `hands`: most of any condition's
/// scene.
void insertMeasures(const Database& database, std::size_t hands);

/// In a transaction, kept or not; returns the SHA-256 of the text.
std::string importPlan(const Database& database, const plan::StudyPlan& plan, const plan::RunChoice& choice,
                       const std::vector<MeshContent>& meshes, const std::vector<PictureContent>& pictures,
                       const OpenOptions& options, bool keep);

}  // namespace passung::store
