#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/triangle_tree.h"

/// The inner loops of MeshBlockSampler. Which triangles may be nearest is found in single precision with room for its
/// rounding, what they are away then in double precision: the same bits whatever the instructions.
namespace passung::field {

inline constexpr std::size_t kLanes = 8;  // points are measured in groups of so many
inline constexpr double kReach = 7.0;     // cells: no point of a block is farther from its centre

/// An edge in the frame of its triangle.
struct FrameEdge {
    float x, y, share_x, share_y;  // `share` · way: the part of the edge
    float inward_x, inward_y;      // of unit length; 0: has no inside
};

/// A triangle prepared for distances.
struct FlatTriangle {
    std::array<Vec3, 3> corner, edge, inward;  // what points from each edge into the triangle
    std::array<double, 3> inverse_square;      // of each edge's length
    Vec3 normal;                               // 0 if the triangle has no area to speak of: then it is its edges
    /// A frame of its own: along its longest edge from that one's first corner, into the triangle, out of its plane.
    Vec3 origin;
    std::array<Eigen::Vector3f, 3> axis;
    double length;            // of the longest edge
    FrameEdge second, third;  // from its end and its beginning to the corner beside it

    explicit FlatTriangle(const geometry::TriangleTree::Corners& t);

    /// To the plane above the inside, else to the nearest edge.
    double squaredDistance(const Vec3& p) const;
};

/// A triangle seen from a block: lengths in cells, points from the block's centre.
struct NearTriangle {
    std::array<float, 4> u, v, n;  // coordinates in the triangle's frame: u[0] x + u[1] y + u[2] z + u[3]
    float length;                  // the first edge ends there on the first axis
    FrameEdge second, third;
    float error;   // of any distance to a point of the block
    float margin;  // inside is what lies so far inside of all edges
    const FlatTriangle* flat;

    NearTriangle(const FlatTriangle& t, const Vec3& centre, double cells_per_metre);
};

/// Some of the triangles of a block, and points in groups, from the block's centre in cells.
using Choice = std::vector<const NearTriangle*>;
using Group = std::array<float, kLanes>;
struct PointGroup {
    Group x, y, z;
};
inline constexpr std::size_t kMostGroups = 4;

/// Some of the triangles of a Choice by their numbers, for each lane.
struct Chosen {
    std::vector<std::uint32_t> words;  // triangle k in bit k % 32 of words[k / 32 · lanes + lane]
    std::size_t lanes = 0;

    bool anyLane(std::size_t k) const {
        std::uint32_t all = 0;
        for (std::size_t i = 0; i < lanes; ++i) all |= words[k / 32 * lanes + i];
        return (all >> k % 32 & 1u) != 0;
    }

    /// Calls `visit(k)`.
    template <class Visit>
    void forEach(std::size_t lane, const Visit& visit) const {
        for (std::size_t w = 0; w * lanes < words.size(); ++w)
            for (std::uint32_t bits = words[w * lanes + lane]; bits != 0; bits &= bits - 1)
                visit(32 * w + static_cast<std::size_t>(std::countr_zero(bits)));
    }
};

struct BlockKernels {
    /// Which triangles may be nearest to each point, for the lanes of all groups.
    void (*nearest)(const Choice&, const PointGroup* groups, std::size_t count, std::vector<float>& scratch, Chosen&);
    /// Which triangles may be nearest to some point of the cubes with a half edge around the points, and to the points.
    ///   Above is the distance u from the triangle nearest to a cube's centre c, convex, hence nowhere above its values
    /// at the corners interpolated; below is the support s of the distance d from a triangle T at c, linear. Where
    /// s > u at all corners T is nowhere nearest. (As s(c + δ) + s(c - δ) = 2d and u(c + δ) + u(c - δ) is at least an
    /// edge for some corner, that takes d of half an edge or more: rounding turns the support but little.)
    void (*judge)(const Choice&, const PointGroup& centres, float half, std::vector<float>& scratch, Chosen& cubes,
                  Chosen& points);
};

/// For the instructions that this machine has.
const BlockKernels& blockKernels();

}  // namespace passung::field
