#pragma once

#include <memory>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "ui/presenter/shaded_mesh.h"

namespace passung::presenter {

/// A sign in the picture for what a trial asks for.
struct Mark {
    std::shared_ptr<const ShadedMesh> mesh;  // shared_ptr: scenes of a study have marks in common
    Pose X_W;
    bool pale = false;  // an image of the held part, where it shall be put
};

/// A round line of this radius through these points, at least two [m].
geometry::TriangleMesh lineThrough(const std::vector<Vec3>& points, double radius);

}  // namespace passung::presenter
