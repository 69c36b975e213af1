#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/convex_faces.h"

namespace passung::geometry {

/// Faces near each other as one convex hull: of their corners if these are few, else of the box around them.
struct Cluster {
    Vec3 centre = Vec3::Zero();  // of a ball around its corners, part frame [m]
    double radius = 0.0;
    Vec3 normal = Vec3::Zero();  // of a face, unit; zero without area
    std::uint32_t first = 0;     // its corners
    std::uint32_t count = 0;     // a multiple of kLanes: the last one may stand there several times
    std::uint32_t child = 0;     // the first of two; 0: a face
    std::uint32_t triangle = 0;  // of a face: in the mesh
    bool isFace() const noexcept { return child == 0; }
};

inline constexpr std::uint32_t kLanes = 4;

/// A surface, or a part of one that shares no corner with the rest. Box and corner in the frame of the tree.
struct SurfacePiece {
    Vec3 corner = Vec3::Zero();  // one of its own
    Bounds box;
};

/// One of the meshes of a tree: its faces are ClusterTree::faces()[first … end).
struct TreeMesh {
    std::uint32_t first = 0, end = 0;
    Bounds box;
};

class ClusterTree;

/// A tree and where its part lies.
struct PlacedTree {
    const ClusterTree* tree = nullptr;
    Pose X;
};

/// Binary tree of clusters over the faces of a mesh. Built once, then const.
class ClusterTree {
public:
    explicit ClusterTree(const TriangleMesh& mesh);
    /// All of them as one, in the frame of their poses, near ones beside each other; triangles are numbered on from
    /// tree to tree. @pre not empty
    explicit ClusterTree(std::span<const PlacedTree> trees);

    /// The root is 0.
    const Cluster& operator[](std::uint32_t i) const noexcept { return clusters_[i]; }
    std::size_t size() const noexcept { return clusters_.size(); }
    std::size_t triangleCount() const noexcept { return triangles_; }
    std::size_t memoryBytes() const noexcept {
        return clusters_.size() * sizeof(Cluster) + 3 * sizeof(double) * x_.size();
    }

    Vec3 corner(std::uint32_t i) const noexcept { return {x_[i], y_[i], z_[i]}; }
    /// Coordinates of all corners; those of a cluster lie at [first, first + count).
    const double* x() const noexcept { return x_.data(); }
    const double* y() const noexcept { return y_.data(); }
    const double* z() const noexcept { return z_.data(); }

    /// The kMostPieces largest ones of each mesh.
    std::span<const SurfacePiece> pieces() const noexcept { return pieces_; }
    std::span<const TreeMesh> bodies() const noexcept { return bodies_; }
    /// Clusters that are faces, body by body. The corners of such a one lie in order around it.
    std::span<const std::uint32_t> faces() const noexcept { return faces_; }
    static constexpr std::size_t kMostPieces = 16;

    const Bounds& box() const noexcept { return box_; }
    /// The farthest vertex from the origin of the part frame [m].
    double reach() const noexcept { return reach_; }

private:
    struct Builder;
    struct Joiner;

    void pushCorner(const Vec3& p);
    void pushCornersOf(const Bounds& box);

    std::vector<Cluster> clusters_;
    std::vector<double> x_, y_, z_;  // corners
    std::vector<SurfacePiece> pieces_;
    std::vector<TreeMesh> bodies_;
    std::vector<std::uint32_t> faces_;
    Bounds box_;
    double reach_ = 0.0;
    std::size_t triangles_ = 0;
};

}  // namespace passung::geometry
