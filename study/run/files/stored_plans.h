#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/study_plan.h"
#include "study/run/files/mesh_importer.h"
#include "study/store/read/store_reader.h"

namespace passung::app {

/// The protocols of a database as they are stored there, with the accuracy that was picked and the stable stiffness
/// that was kept; each is read once.
class StoredPlans {
public:
    /// `meshes`: folder that the protocols' mesh paths start from; empty: here, else beside the database.
    StoredPlans(const store::StoreReader& reader, const std::string& meshes, const ImportLimits& limits = {});

    /// Errors: the protocol is not there, or a mesh file of it is missing or another one than at the time.
    Result<const protocol::StudyPlan*> plan(const std::string& sha256);

private:
    Result<protocol::StudyPlan> read(const store::ProtocolRow& row) const;
    Result<Done> compareMeshes(const std::string& sha256, const protocol::StudyPlan& plan) const;

    const store::StoreReader& reader_;
    std::vector<std::filesystem::path> folders_;
    ImportLimits limits_;
    std::map<std::string, protocol::StudyPlan> plans_;
};

}  // namespace passung::app
