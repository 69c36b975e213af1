#pragma once

#include <memory>
#include <utility>

#include "core/scene/build_store.h"
#include "core/scene/mesh_source.h"
#include "study/run/files/disk_store.h"
#include "study/run/files/mesh_importer.h"

namespace passung::run {

/// What builds of parts take from outside: fields and shells that earlier runs kept, if they are kept, and meshes, read
/// by the program passung-import. Where that does not stand beside this program (a test, a program of somebody else)
/// the file is read here, under the same limits of depth and size.
class Builds final : public scene::BuildStore, public scene::MeshSource {
public:
    Builds(std::unique_ptr<DiskStore> kept, const ImportLimits& limits) : kept_(std::move(kept)), limits_(limits) {}

    std::optional<std::string> load(const std::string& name) override;
    void keep(const std::string& name, std::string_view bytes) override;
    Result<importer::ImportedMesh> importMesh(const std::string& path, double metres_per_unit) override;

private:
    std::unique_ptr<DiskStore> kept_;
    ImportLimits limits_;
    std::optional<std::filesystem::path> program_ = importProgram();
};

std::unique_ptr<Builds> openBuilds(const ImportLimits& limits = {});

}  // namespace passung::run
