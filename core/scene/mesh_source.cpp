#include "core/scene/mesh_source.h"

namespace passung::scene {

Result<importer::ImportedMesh> importMeshFile(const MeshFile& file, BuildStore* store) {
    if (auto* source = dynamic_cast<MeshSource*>(store)) return source->importMesh(file.path, file.metres_per_unit);
    return importer::importMesh(file.path, file.metres_per_unit);
}

}  // namespace passung::scene
