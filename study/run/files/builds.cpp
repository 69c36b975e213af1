#include "study/run/files/builds.h"

namespace passung::run {

std::optional<std::string> Builds::load(const std::string& name) { return kept_ ? kept_->load(name) : std::nullopt; }

void Builds::keep(const std::string& name, std::string_view bytes) {
    if (kept_) kept_->keep(name, bytes);
}

Result<importer::ImportedMesh> Builds::importMesh(const std::string& path, double metres_per_unit) {
    if (!program_) return importer::importMesh(path, metres_per_unit);
    return importElsewhere(*program_, path, metres_per_unit, limits_);
}

std::unique_ptr<Builds> openBuilds(const ImportLimits& limits, BuildWatch told) {
    return std::make_unique<Builds>(openDiskStore(), limits, std::move(told));
}

}  // namespace passung::run
