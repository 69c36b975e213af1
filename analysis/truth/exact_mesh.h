#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::truth {

using Corners = std::array<Vec3, 3>;

/// Exact questions to one mesh, answered by other means than the contact core's: a tree of boxes for the closest
/// triangle, ray parity for the inside. Built once, then const; every query is thread-safe. Mesh frame, metres.
class ExactMesh {
public:
    /// @pre at least one triangle, finite vertices.
    explicit ExactMesh(const geometry::TriangleMesh& mesh);

    struct Nearest {
        double distance = 0.0;       // unsigned [m]
        std::uint32_t triangle = 0;  // index in the mesh
    };

    /// Exact closest triangle.
    Nearest nearest(const Vec3& p) const;

    /// Is `p` inside? Rays in five fixed, irregular directions count the triangles that they cross; the majority of
    /// odd counts decides. Only for watertight meshes; within rounding of the surface either answer is right.
    bool contains(const Vec3& p) const;

    /// Positive outside [m].
    double signedDistance(const Vec3& p) const;

    /// Indices of all triangles that come within `radius` of `p`, and perhaps some more.
    void collectAround(const Vec3& p, double radius, std::vector<std::uint32_t>& triangles) const;

    const std::vector<Corners>& triangles() const { return triangles_; }
    const geometry::Bounds& bounds() const { return bounds_; }

private:
    /// The triangles as one ray direction sees them: corners turned so that the ray runs along +z, in bins over x, y.
    struct RayView {
        Mat3 turn;
        std::vector<Corners> corners;
        int bins = 1;  // per axis
        double low_x = 0.0, low_y = 0.0, inverse_bin_x = 0.0, inverse_bin_y = 0.0;
        std::vector<std::uint32_t> bin_start, bin_triangles;
        bool odd(const Vec3& p) const;
    };

    /// A box around the triangles `first` to `end` of the tree's order.
    struct Node {
        geometry::Bounds box;
        std::uint32_t first, end;
        std::uint32_t right = 0;  // 0: leaf; the left child follows its parent
    };
    std::uint32_t grow(std::uint32_t first, std::uint32_t end);
    RayView buildView(const Mat3& turn) const;

    std::vector<Corners> triangles_;
    geometry::Bounds bounds_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;  // of the triangles in the tree
    std::vector<Corners> sorted_;       // the triangles in that order
    std::vector<RayView> views_;
};

/// Distance of `p` from the triangle [m].
double distanceToTriangle(const Vec3& p, const Corners& triangle);

/// How deep one surface reaches into the other solid.
struct DeepestPoint {
    double depth = 0.0;         // [m], ≥ 0; 0: nothing is inside
    double uncertainty = 0.0;   // the true depth of the meshes lies in [depth, depth + uncertainty] [m]
    Vec3 point = Vec3::Zero();  // a point of the surface with that depth, in the solid's frame
    std::size_t pieces = 0;     // of the surface that were looked at
};

/// The deepest point of the whole surface of `surface` inside the watertight `solid`, by branch and bound.
/// `uncertainty` ≤ `resolution` [m] unless `max_pieces` ended the search.
/// @pre `X_FS` (surface to solid) is finite, resolution > 0.
DeepestPoint deepestPoint(const ExactMesh& solid, const ExactMesh& surface, const Pose& X_FS, double resolution,
                          std::size_t max_pieces = 2'000'000);

}  // namespace passung::truth
