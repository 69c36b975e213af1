#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/truth/exact_mesh.h"

namespace passung::truth {

/// Do two triangles have a point in common? Those in one plane, and those that only touch, count as apart.
bool triangleMeets(const Corners& a, const Corners& b);

/// The triangles of a mesh in a tree of boxes, closed or not: what crosses them, which is nearest, what is inside.
/// Nothing of the contact core. Built once, then const and thread-safe; mesh frame, metres.
class TriangleBoxes {
public:
    /// @pre at least one triangle, finite vertices.
    explicit TriangleBoxes(const geometry::TriangleMesh& mesh);

    /// A node of the tree: the first is the root, node 0. Its triangles are triangles()[first … end).
    struct Node {
        geometry::Bounds box;      // along the axes
        std::array<Vec3, 8> hull;  // corners of a box that lies along the surface, all triangles within
        std::uint32_t first_vertex = 0, vertices = 0;  // in vertices(); none of large branches
        std::uint32_t first = 0, end = 0;
        std::uint32_t right = 0;     // 0: leaf; the left child follows its parent
        Vec3 centre = Vec3::Zero();  // of the areas below
        Vec3 dipole = Vec3::Zero();  // sum of area · normal below [m²]
        double far_squared = 0.0;    // from where on `dipole` stands for the triangles [m²]
    };
    std::span<const Node> nodes() const { return nodes_; }
    std::span<const Corners> triangles() const { return triangles_; }
    /// Every vertex below a node once; empty for more than some thousand triangles.
    std::span<const Vec3> vertices(const Node& node) const {
        return std::span(vertices_).subspan(node.first_vertex, node.vertices);
    }

    struct Nearest {
        double distance = 0.0;  // [m]
        std::uint32_t triangle = 0;
    };
    Nearest nearest(const Vec3& p) const;

    /// Is any triangle met by `t`? See triangleMeets.
    bool isMetBy(const Corners& t) const;

    /// Winding number: the solid angle of all triangles by 4π; that of a cluster, from afar, by its dipole (Barill
    /// et al. 2018), which errs by less than 0.05. 1 inside, 0 outside, in between near gaps.
    double windingNumber(const Vec3& p) const;
    bool contains(const Vec3& p) const { return windingNumber(p) > 0.5; }

private:
    std::uint32_t grow(std::uint32_t first, std::uint32_t end);
    void enclose(Node& node) const;
    void listVertices(Node& node);

    std::vector<Corners> triangles_;
    std::vector<Node> nodes_;
    std::vector<Vec3> vertices_;
};

}  // namespace passung::truth
