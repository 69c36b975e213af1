#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/model/point_shell.h"

namespace passung::model {

/// A cluster of shell points: a real point that stands for it and a sphere around all points below.
struct SphereNode {
    Vec3 centre;              // of the sphere [m]
    double radius;            // encloses every point below [m]
    Vec3 point;               // the representative, a point of the shell
    Vec3 normal;              // its outward normal
    double area;              // sum over the points below [m²]
    std::uint32_t first = 0;  // first child node, or first point if this is a leaf
    std::uint32_t count = 0;
    bool leaf = false;
};

/// Point-sphere tree over a shell: clusters of clusters of points, coarsest level first, the children of a node
/// contiguous. Every level samples the whole surface with real points of it. (Sagardia 2019, 3.2.4, reconstructed.)
class SphereTree {
public:
    /// @pre at least one point. Clusters join points whose normals are within 60°, where that leaves any choice.
    explicit SphereTree(const PointShell& shell);

    std::span<const SphereNode> nodes() const { return nodes_; }
    std::span<const SphereNode> roots() const { return std::span(nodes_).first(root_count_); }
    /// In tree order: the points of a leaf are contiguous.
    std::span<const SurfacePoint> points() const { return points_; }
    double totalArea() const { return total_area_; }
    double coverRadius() const { return cover_radius_; }
    int levels() const { return levels_; }
    /// Root mean square distance of the points from the part's origin [m]: makes rotation and translation comparable.
    double gyrationRadius() const { return gyration_radius_; }
    /// Distance of the farthest point from the part's origin [m].
    double reach() const { return reach_; }

private:
    std::vector<SphereNode> nodes_;
    std::vector<SurfacePoint> points_;
    std::size_t root_count_ = 0;
    double total_area_ = 0.0, cover_radius_ = 0.0, gyration_radius_ = 0.0, reach_ = 0.0;
    int levels_ = 0;
};

}  // namespace passung::model
