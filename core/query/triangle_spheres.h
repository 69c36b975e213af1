#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::query {

/// A tree of spheres over the triangles of a mesh; what lies side by side is close together in memory.
struct TriangleSpheres {
    struct Node {
        Vec3 centre;  // of a sphere around the triangles below; each coordinate is exactly a float
        double radius;
        std::uint32_t first, count;  // faces if count > 0, else children first and first + 1
    };
    /// A vertex of the mesh, and what a search learns there.
    struct Vertex {
        Vec3 p;
        double distance = 0.0;    // from the other mesh, at least [m]
        std::uint64_t round = 0;  // of the search
    };

    /// @pre at least one triangle.
    explicit TriangleSpheres(const geometry::TriangleMesh& mesh);

    std::vector<Node> nodes;  // the root first
    std::vector<geometry::Triangle> faces;
    std::vector<Vertex> vertices;
    double leaf_radius = 0.0;     // mean [m]
    double float_rounding = 0.0;  // how far a point of the surface moves when it is rounded to floats [m]

private:
    struct Range;
    void buildNodes(const geometry::TriangleMesh& mesh, std::vector<std::uint32_t>& order);
    void copyTriangles(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& order);
};

}  // namespace passung::query
