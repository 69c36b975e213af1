#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "study/plan/frozen_plan.h"
#include "study/run/freeze.h"
#include "study/store/read/store_reader.h"

namespace passung::run {

/// Values that the database keeps for the protocol with this hash.
Result<KeptPlan> keptPlan(const store::StoreReader& reader, const std::string& sha256);

/// The protocols of a database as it runs them; each is read once.
class StoredPlans {
public:
    /// `meshes`: folder that the protocols' mesh paths start from; empty: here, else beside the database.
    StoredPlans(const store::StoreReader& reader, const std::string& meshes, const ImportLimits& limits = {});

    /// Plan of the protocol with this hash; its questionnaires are not opened. Errors: as of draft() and freeze().
    Result<plan::FrozenPlan> plan(const std::string& sha256);

    /// The stored text, read with the stable stiffness that was kept. Errors: the protocol is not there, or a mesh file
    /// of it is missing or another one than at the time.
    Result<plan::StudyPlan> draft(const std::string& sha256) const;

private:
    Result<plan::StudyPlan> read(const store::ProtocolRow& row) const;
    Result<Done> compareMeshes(const std::string& sha256, const plan::StudyPlan& plan) const;

    const store::StoreReader& reader_;
    std::vector<std::filesystem::path> folders_;
    ImportLimits limits_;
    std::map<std::string, plan::FrozenPlan> plans_;
};

}  // namespace passung::run
