#include "study/run/files/watched_store.h"

#include <algorithm>
#include <utility>

namespace passung::run {

void WatchedStore::begin(std::size_t pieces, Watch watch) {
    pieces_ = pieces;
    done_ = 0;
    watch_ = std::move(watch);
}

std::optional<std::string> WatchedStore::load(const std::string& name) {
    auto found = store_ == nullptr ? std::nullopt : store_->load(name);
    if (found)
        ++done_;
    else
        tell();
    return found;
}

void WatchedStore::keep(const std::string& name, std::string_view bytes) {
    if (store_ != nullptr) store_->keep(name, bytes);
    ++done_;
    tell();
}

Result<importer::ImportedMesh> WatchedStore::importMesh(const std::string& path, double metres_per_unit) {
    return scene::importMeshFile(scene::MeshFile{path, metres_per_unit}, store_);
}

void WatchedStore::tell() const {
    const auto pieces = static_cast<double>(std::max<std::size_t>(pieces_, 1));
    if (watch_ && !watch_(std::min(1.0, static_cast<double>(done_) / pieces))) throw BuildCancelled();
}

}  // namespace passung::run
