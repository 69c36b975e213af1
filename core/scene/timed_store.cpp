#include "core/scene/timed_store.h"

#include "core/base/bytes.h"

namespace passung::scene {

namespace {

std::string timeName(const std::string& name) { return name + ".seconds"; }

}  // namespace

std::optional<std::string> TimedStore::load(const std::string& name) {
    std::optional<std::string> bytes;
    if (store_ != nullptr) {
        if (const auto time = store_->load(timeName(name))) {
            if (const auto content = unsealed(name, *time)) {
                ByteReader reader(*content);
                seconds_[name] = reader.takeDouble();
                bytes = store_->load(name);
            }
        }
    }
    asked_ = std::chrono::steady_clock::now();
    return bytes;
}

void TimedStore::keep(const std::string& name, std::string_view bytes) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked_).count();
    seconds_[name] = seconds;
    if (store_ == nullptr) return;
    store_->keep(name, bytes);
    ByteWriter writer;
    writer.put(seconds);
    store_->keep(timeName(name), sealed(name, writer.take()));
}

Result<importer::ImportedMesh> TimedStore::importMesh(const std::string& path, double metres_per_unit) {
    return scene::importMeshFile(MeshFile{path, metres_per_unit}, store_);
}

double TimedStore::seconds() const {
    double sum = 0.0;
    for (const auto& [name, seconds] : seconds_) sum += seconds;
    return sum;
}

}  // namespace passung::scene
