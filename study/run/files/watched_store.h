#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>

#include "core/scene/build_store.h"
#include "core/scene/mesh_source.h"

namespace passung::run {

/// A build was given up between two of its pieces.
struct BuildCancelled : std::runtime_error {
    BuildCancelled() : std::runtime_error("building the parts was cancelled") {}
};

/// Another store, or none, through which somebody watches a build: its pieces are the fields and shells that are asked
/// for. Those that are there take no time and are not told of.
class WatchedStore final : public scene::BuildStore, public scene::MeshSource {
public:
    /// What is known of a build: the share of its pieces that are done. False: it is to be given up.
    using Watch = std::function<bool(double share)>;

    explicit WatchedStore(scene::BuildStore* store) : store_(store) {}

    /// A build of at most so many pieces begins.
    void begin(std::size_t pieces, Watch watch);

    /// Both throw BuildCancelled; what is to be kept is kept before.
    std::optional<std::string> load(const std::string& name) override;
    void keep(const std::string& name, std::string_view bytes) override;
    void building(const scene::BuildStep& step) override {
        if (store_ != nullptr) store_->building(step);
    }
    Result<importer::ImportedMesh> importMesh(const std::string& path, double metres_per_unit) override;

private:
    void tell() const;

    scene::BuildStore* store_;
    std::size_t pieces_ = 0, done_ = 0;
    Watch watch_;
};

}  // namespace passung::run
