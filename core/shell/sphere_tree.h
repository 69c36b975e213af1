#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/surface_walk.h"
#include "core/shell/point_shell.h"

namespace passung::shell {

/// A cluster of shell points: a sphere around all points below, and a real point that stands for them.
struct SphereNode {
    Vec3 centre;              // of the sphere [m]; each coordinate is exactly a float
    double radius;            // about the smallest that encloses every point below [m]
    std::uint32_t first = 0;  // first child node, or first point if this is a leaf
    std::uint32_t count = 0;
    bool leaf = false;
    std::uint32_t first_group = 0;  // of a leaf: see SphereTree::groupPositions
    Vec3 point;                     // the representative, the point of the shell nearest to the middle of those below
    Vec3 normal;                    // unit: the direction of Σ area · normal over the points below
    double facing_area;             // its length [m²]: what the cluster weighs in a wrench; ≤ area
    double area;                    // Σ area over the points below [m²]
};

/// What a point or a group weighs in a wrench; as floats, for what reads many.
struct Facing {
    Eigen::Vector3f normal;
    float area;
};

/// Positions by axis, for loops over many; coordinates are floats, exactly.
class FloatPositions {
public:
    void add(float x, float y, float z) {
        x_.push_back(x);
        y_.push_back(y);
        z_.push_back(z);
    }
    std::span<const float> x(std::size_t first, std::size_t count) const { return std::span(x_).subspan(first, count); }
    std::span<const float> y(std::size_t first, std::size_t count) const { return std::span(y_).subspan(first, count); }
    std::span<const float> z(std::size_t first, std::size_t count) const { return std::span(z_).subspan(first, count); }
    Vec3 at(std::size_t i) const {
        return {static_cast<double>(x_[i]), static_cast<double>(y_[i]), static_cast<double>(z_[i])};
    }

private:
    std::vector<float> x_, y_, z_;
};

/// Point-sphere tree over a shell: clusters of clusters of points, coarsest level first, the children of a node
/// contiguous. Every level samples the whole surface with real points of it, together with the leaves that end above
/// it. (Sagardia 2019, 3.2.4, reconstructed.) Built in O(n log n).
class SphereTree {
public:
    static constexpr std::uint32_t kLeafPoints = 32;  // at most, in one leaf
    static constexpr std::uint32_t kChildren = 8;     // at most, of one node, and roots
    static constexpr std::uint32_t kGroupPoints = 4;  // at most, in one group
    static constexpr std::uint32_t kLeafGroups = kLeafPoints / kGroupPoints;

    /// @pre at least one point. Below the roots no cluster holds two faces whose normals differ by more than 120°, so
    /// that none joins the two sides of a wall: the children of the roots part them, and what is below is halved across
    /// its longest side.
    /// `mesh`: what the shell was sampled from, for surface(); none: an empty one.
    explicit SphereTree(const PointShell& shell, const geometry::TriangleMesh& mesh = {});

    std::span<const SphereNode> nodes() const { return nodes_; }
    std::span<const SphereNode> roots() const { return std::span(nodes_).first(root_count_); }
    /// In tree order: the points below a node are contiguous.
    std::span<const SurfacePoint> points() const { return points_; }
    /// Of points() and of the centres of nodes().
    const FloatPositions& positions() const { return positions_; }
    /// Of points().
    std::span<const Facing> facings() const { return facings_; }
    /// Groups: a few neighbours of a leaf each, in tree order. Their mean position, and the direction and the length of
    /// Σ area · normal over them: where φ is linear and the surface flat, a group weighs what its points weigh.
    const FloatPositions& groupPositions() const { return group_positions_; }
    std::span<const Facing> groupFacings() const { return group_facings_; }
    /// How far the points of a group lie from its position, rounded up.
    std::span<const float> groupRadii() const { return group_radii_; }
    /// Of each group the first point; one more for the end.
    std::span<const std::uint32_t> groupPoints() const { return group_points_; }
    const FloatPositions& centres() const { return centres_; }
    /// Of nodes(), rounded up.
    std::span<const float> radii() const { return radii_; }
    /// The surface that the points were sampled from.
    const geometry::SurfaceWalk& surface() const { return surface_; }
    double totalArea() const { return total_area_; }
    double coverRadius() const { return cover_radius_; }
    /// How far a point may lie from the surface because it is rounded to floats [m].
    double rounding() const { return rounding_; }
    int levels() const { return levels_; }
    /// Root mean square distance of the points from the part's origin [m]: makes rotation and translation comparable.
    double gyrationRadius() const { return gyration_radius_; }
    /// Distance of the farthest point from the part's origin [m].
    double reach() const { return reach_; }
    std::size_t memoryBytes() const;

private:
    void formGroups();

    std::vector<SphereNode> nodes_;
    std::vector<SurfacePoint> points_;
    FloatPositions positions_, centres_;
    std::vector<float> radii_;
    std::vector<Facing> facings_, group_facings_;
    FloatPositions group_positions_;
    std::vector<float> group_radii_;
    std::vector<std::uint32_t> group_points_;
    geometry::SurfaceWalk surface_;
    std::size_t root_count_ = 0;
    double total_area_ = 0.0, cover_radius_ = 0.0, rounding_ = 0.0, gyration_radius_ = 0.0, reach_ = 0.0;
    int levels_ = 0;
};

}  // namespace passung::shell
