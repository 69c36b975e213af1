#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "core/scene/build_store.h"
#include "core/scene/mesh_source.h"
#include "study/run/files/disk_store.h"
#include "study/run/files/mesh_importer.h"

namespace passung::run {

/// Told what of a part is being built; see scene::BuildStore::building().
using BuildWatch = std::function<void(const scene::BuildStep&)>;

/// What builds of parts take from outside: fields and shells that earlier runs kept, if they are kept, and meshes, read
/// by the program passung-import. Where that does not stand beside this program (a test, a program of somebody else)
/// the file is read here, under the same limits of depth and size.
class Builds final : public scene::BuildStore, public scene::MeshSource {
public:
    Builds(std::unique_ptr<DiskStore> kept, const ImportLimits& limits, BuildWatch told = {})
        : kept_(std::move(kept)), limits_(limits), told_(std::move(told)) {}

    std::optional<std::string> load(const std::string& name) override;
    void keep(const std::string& name, std::string_view bytes) override;
    void building(const scene::BuildStep& step) override {
        if (told_) told_(step);
    }
    Result<importer::ImportedMesh> importMesh(const std::string& path, double metres_per_unit) override;

private:
    std::unique_ptr<DiskStore> kept_;
    ImportLimits limits_;
    BuildWatch told_;
    std::optional<std::filesystem::path> program_ = importProgram();
};

std::unique_ptr<Builds> openBuilds(const ImportLimits& limits = {}, BuildWatch told = {});

}  // namespace passung::run
