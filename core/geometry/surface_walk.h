#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::geometry {

/// Straight ways along the triangles of a surface, across their edges; part frame, metres. In single precision: a way
/// leaves the surface by some roundings.
class SurfaceWalk {
public:
    /// A point of the surface, on one of its triangles.
    struct WalkPlace {
        std::uint32_t triangle;
        Eigen::Vector3f position;
    };

    explicit SurfaceWalk(const TriangleMesh& mesh);

    std::size_t size() const { return faces_.size(); }
    std::size_t memoryBytes() const { return faces_.size() * sizeof(Face); }

    /// Two unit vectors along a triangle, square to each other; zero if it has no area.
    std::array<Eigen::Vector3f, 2> axes(std::uint32_t triangle) const noexcept {
        const Face& face = faces_[triangle];
        return {face.inward[0], face.normal.cross(face.inward[0])};
    }

    /// From `place` as far as `step` is long, first along its part in the plane of the triangle; over an edge the way
    /// goes on as if both triangles were laid flat. It ends early at an edge that is not shared by exactly two
    /// triangles, at a triangle without area, and in the last of kMostFaces triangles. rt-safe.
    /// @pre place.triangle < size()
    WalkPlace moved(WalkPlace place, Eigen::Vector3f step) const noexcept;
    static constexpr int kMostFaces = 8;

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Face {
        std::array<Eigen::Vector3f, 3> corner;
        std::array<Eigen::Vector3f, 3> inward;  // unit, in the plane, square to the edge from corner k to the next
        Eigen::Vector3f normal;                 // unit
        std::array<std::uint32_t, 3> across;    // over that edge: 4 · triangle + its number there; kNone: none or many
    };
    std::vector<Face> faces_;
};

}  // namespace passung::geometry
