#include "study/run/files/stored_plans.h"
#include "study/run/files/protocol_files.h"

#include <algorithm>

#include "core/base/digest.h"
#include "core/base/regular_file.h"
#include "study/run/machine/calibration.h"

namespace passung::run {

Result<KeptPlan> keptPlan(const store::StoreReader& reader, const std::string& sha256) {
    auto stable = reader.stableStiffness(sha256);
    if (!stable) return stable.errors();
    auto accuracy = reader.accuracy();
    if (!accuracy) return accuracy.errors();
    std::erase_if(*accuracy, [&](const store::AccuracyRow& row) { return row.protocol_sha256 != sha256; });
    auto geometry = reader.contactGeometry(sha256);
    if (!geometry) return geometry.errors();
    return KeptPlan{sha256, *std::move(stable), *std::move(accuracy), *std::move(geometry)};
}

StoredPlans::StoredPlans(const store::StoreReader& reader, const std::string& meshes, const ImportLimits& limits)
    : reader_(reader), limits_(limits) {
    // Where the protocol's file was is not stored: a path of one machine means nothing on another.
    if (!meshes.empty()) {
        folders_ = {meshes};
    } else {
        folders_ = {"", std::filesystem::path(reader.path()).parent_path()};
    }
}

Result<plan::FrozenPlan> StoredPlans::plan(const std::string& sha256) {
    if (const auto known = plans_.find(sha256); known != plans_.end()) return known->second;
    const auto draft = this->draft(sha256);
    if (!draft) return draft.errors();
    const auto kept = keptPlan(reader_, sha256);
    if (!kept) return kept.errors();
    const auto plan = freeze(*draft, *kept, {}, limits_);
    if (plan) plans_.emplace(sha256, *plan);
    return plan;
}

Result<plan::StudyPlan> StoredPlans::draft(const std::string& sha256) const {
    const auto rows = reader_.protocols();
    if (!rows) return rows.errors();
    for (const auto& row : *rows)
        if (row.sha256 == sha256) return read(row);
    return Error{.message = "is not in the database", .key = "protocol", .value = sha256};
}

/// The stored protocol with the mesh files of the first folder that has them all.
Result<plan::StudyPlan> StoredPlans::read(const store::ProtocolRow& row) const {
    const auto stable = reader_.stableStiffness(row.sha256);
    if (!stable) return stable.errors();
    const auto devices = devicesAsKept(*stable);
    Errors errors;
    for (const std::filesystem::path& folder : folders_) {
        auto plan = readBegunProtocol(row.source_text, (folder / (row.name + ".toml")).string(), devices, limits_);
        if (!plan) {
            if (errors.empty()) errors = plan.errors();
            continue;
        }
        if (const auto same = compareMeshes(row.sha256, *plan); !same) return same.errors();
        return plan;
    }
    errors.push_back({.message = "the stored protocol cannot be read here; its mesh paths start from this folder or "
                                 "the database's: --meshes names another",
                      .file = reader_.path()});
    return errors;
}

/// A replay with another geometry would prove nothing.
Result<Done> StoredPlans::compareMeshes(const std::string& sha256, const plan::StudyPlan& plan) const {
    const auto rows = reader_.meshes();
    if (!rows) return rows.errors();
    Errors errors;
    for (const plan::NamedMesh& mesh : plan.meshes) {
        const auto stored = std::find_if(rows->begin(), rows->end(), [&](const store::MeshRow& row) {
            return row.protocol_sha256 == sha256 && row.mesh == mesh.name;
        });
        const auto bytes = readRegularFile(mesh.path, kMostMeshBytes);
        if (!bytes) return bytes.errors();
        if (stored == rows->end()) {
            errors.push_back({.message = "the database does not know this mesh file", .file = mesh.path});
        } else if (const std::string found = sha256Hex(*bytes); found != stored->sha256) {
            errors.push_back(
                {.message = "is not the mesh file of the recorded trials, whose SHA-256 is " + stored->sha256,
                 .file = mesh.path,
                 .key = "SHA-256",
                 .value = found});
        }
    }
    if (!errors.empty()) return errors;
    return Done{};
}

}  // namespace passung::run
