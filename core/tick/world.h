#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/closed_form/solid.h"
#include "core/geometry/cluster_tree.h"
#include "core/geometry/mesh.h"
#include "core/geometry/triangle_tree.h"
#include "core/scene/contact_geometry.h"
#include "core/scene/scene.h"

namespace passung::tick {

/// A part of the scene, as what contact with it is computed from. Borrows the scene's.
struct Body {
    Pose X_WP_start;     // part to world, where a trial begins
    bool moves = false;  // a hand holds it, or may pick it up
    double reach = 0.0;  // no point is farther from its origin [m]; known of those that move
    // Geometry::Field only, as far as anybody asks for it
    const field::DistanceField* field = nullptr;
    const shell::SphereTree* shell = nullptr;
    const shell::EdgeCurves* edges = nullptr;         // with the shell
    const geometry::ClusterTree* surface = nullptr;   // Geometry::Surface only
    const geometry::ClusterTree* clusters = nullptr;  // the same, and of parts that keep apart in any geometry
    const closed_form::SmoothSolid* solid = nullptr;  // Geometry::ClosedForm only; parts of one shape share it
    geometry::Bounds box = {};                        // that holds it, in its frame [m]
    const geometry::TriangleTree* faces = nullptr;    // of parts that can be picked up; equal ones share it
};

/// The parts of a scene and what they share, for all hands. Does not change while a trial runs. Borrows the scene's
/// parts.
struct World {
    scene::Geometry geometry = scene::Geometry::Field;
    std::vector<Body> bodies;                      // in the order of the scene
    std::vector<closed_form::SmoothSolid> solids;  // Geometry::ClosedForm only: one of each shape
    std::vector<geometry::TriangleTree> faces;     // of parts that can be picked up: one of each mesh
    // Geometry::Surface only: all that rest for good, in the world, as one or none; and of each its first triangle
    // there
    std::vector<geometry::ClusterTree> still_surface;
    std::vector<std::uint32_t> first_triangles;
};

/// @pre `scene` outlives the result
World makeWorld(const scene::Scene& scene);

}  // namespace passung::tick
