#pragma once

#include <string>

#include "core/base/result.h"
#include "core/import/mesh_import.h"
#include "core/scene/build_store.h"
#include "core/scene/scene_spec.h"

namespace passung::scene {

/// Reads meshes for whoever builds parts: a BuildStore that is one, too, is asked for them.
class MeshSource {
public:
    virtual ~MeshSource() = default;
    /// As importer::importMesh(), in whatever process.
    virtual Result<importer::ImportedMesh> importMesh(const std::string& path, double metres_per_unit) = 0;
};

/// By the store if it is a MeshSource, else in this process.
Result<importer::ImportedMesh> importMeshFile(const MeshFile& file, BuildStore* store);

}  // namespace passung::scene
