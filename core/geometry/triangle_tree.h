#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/geometry/triangle_distance.h"

namespace passung::geometry {

/// Closest point on a set of triangles.
struct ClosestPoint {
    double distance = 0.0;  // [m], unsigned
    Vec3 point = Vec3::Zero();
    std::uint32_t triangle = 0;  // in the mesh
    std::uint32_t place = 0;     // in the tree
};

/// Bounding volume hierarchy over the triangles of a mesh: exact distance and winding number.
/// Built once, then const; every query is thread-safe and deterministic.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleMesh& mesh);  // copies what it needs; @pre at least one triangle

    /// Exact; searches no farther than `limit` (then distance = limit and the point is meaningless).
    ClosestPoint closest(const Vec3& p, double limit = 1e300) const;

    struct Corners {
        Vec3 a, b, c;
        bool needle;  // very long for its height, or without area
    };

    /// Appends the triangles whose box comes within `radius` of `p`, numbered in tree order.
    void findNear(const Vec3& p, double radius, std::vector<std::uint32_t>& found) const;

    /// Appends the triangles that reach as far as `least` along `way` and whose box meets `box`, numbered in tree
    /// order.
    void findAbove(const Bounds& box, const Vec3& way, double least, std::vector<std::uint32_t>& found) const;

    /// Appends the triangles that may be nearest to some point of the cube with half edge `half` around `centre`, all
    /// those that meet it among them, numbered in tree order.
    void findNearest(const Vec3& centre, double half, std::vector<std::uint32_t>& found) const;

    /// All triangles in tree order.
    const std::vector<Corners>& corners() const { return corners_; }

    /// The number in the mesh of the triangle at a place in tree order.
    std::uint32_t numberOf(std::uint32_t place) const { return original_[place]; }

    /// The nearest points of `triangle` (first) and the mesh (second), if they are nearer than `limit`; else a distance
    /// of `limit`.
    TrianglePair closestTo(const TriangleCorners& triangle, double limit) const;

    /// The corners of a triangle that closest() names.
    TriangleCorners cornersOf(const ClosestPoint& point) const {
        return {corners_[point.place].a, corners_[point.place].b, corners_[point.place].c};
    }

    /// Generalised winding number (Jacobson 2013) with dipoles for far clusters (Barill 2018): about 1 inside, 0
    /// outside.
    double windingNumber(const Vec3& p) const;

    bool inside(const Vec3& p) const { return windingNumber(p) > 0.5; }

private:
    static constexpr int kSahDepth = 32;           // below: halves, so that the depth stays under kStack
    static constexpr int kStack = kSahDepth + 40;  // log2(2^32) and slack

    struct Node {
        Vec3 low, high;              // box
        std::uint32_t first, count;  // triangles if a leaf (count > 0), else left child = first, right = first + 1
    };
    /// What a node's triangles look like from afar.
    struct Cluster {
        Vec3 centre;         // area-weighted centre of the triangles below
        Vec3 dipole;         // sum of area · normal [m²]
        double far_squared;  // a point farther than this (squared) from `centre` sees the dipole [m²]
    };
    Cluster summarise(std::uint32_t first, std::uint32_t count) const;
    template <class Enters, class Visit>
    void walk(Enters enters, Visit visit) const;

    std::vector<Node> nodes_;
    std::vector<Cluster> clusters_;        // per node
    std::vector<Corners> corners_;         // in tree order
    std::vector<std::uint32_t> original_;  // index in the mesh, in tree order
};

}  // namespace passung::geometry
