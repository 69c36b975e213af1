#include "core/scene/mesh_source.h"

namespace passung::model {

Result<ImportedMesh> importMeshFile(const MeshFile& file, BuildStore* store) {
    if (auto* source = dynamic_cast<MeshSource*>(store)) return source->importMesh(file.path, file.metres_per_unit);
    return importMesh(file.path, file.metres_per_unit);
}

}  // namespace passung::model
