#include "core/model/mesh.h"

namespace passung::model {

Bounds boundsOf(const TriangleMesh& mesh) {
    Bounds bounds;
    for (const Vec3& vertex : mesh.vertices) bounds.extend(vertex);
    return bounds;
}

}  // namespace passung::model
