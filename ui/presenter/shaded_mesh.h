#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/mesh.h"

namespace passung::presenter {

/// A surface as a graphics card takes it: a vertex per corner that has a normal of its own.
struct ShadedMesh {
    struct Vertex {
        std::array<float, 3> position_mm, normal;
        friend bool operator==(const Vertex&, const Vertex&) = default;
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  // three a triangle
    std::array<float, 3> low_mm{}, high_mm{};
    bool two_sided = false;  // its inside can be seen: it is open, or its triangles do not all face outwards
};

/// Smooth where neighbouring triangles meet at less than `crease` [rad], an edge elsewhere: the normal of a corner is
/// the mean, weighted by area, over the triangles around its vertex that face within `crease` of its own.
ShadedMesh shade(const geometry::TriangleMesh& mesh, double crease = 0.6);

}  // namespace passung::presenter
