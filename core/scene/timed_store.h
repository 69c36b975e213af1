#pragma once

#include <chrono>
#include <map>
#include <string>

#include "core/scene/build_store.h"
#include "core/scene/mesh_source.h"

namespace passung::scene {

/// Another store, or none, and how long that which is taken from it or kept in it took to build: from asking for it in
/// vain to keeping it. That time is kept beside it; what comes without one is not taken, so that it is built, and
/// timed, anew. For one build after another in one thread.
class TimedStore : public BuildStore, public MeshSource {
public:
    explicit TimedStore(BuildStore* store) : store_(store) {}
    std::optional<std::string> load(const std::string& name) override;
    void keep(const std::string& name, std::string_view bytes) override;
    void building(const BuildStep& step) override {
        if (store_ != nullptr) store_->building(step);
    }
    Result<importer::ImportedMesh> importMesh(const std::string& path, double metres_per_unit) override;
    /// Wall time of all that was taken or kept [s].
    double seconds() const;

private:
    BuildStore* store_;
    std::chrono::steady_clock::time_point asked_;
    std::map<std::string, double> seconds_;
};

}  // namespace passung::scene
