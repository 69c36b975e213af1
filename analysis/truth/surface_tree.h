#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/truth/exact_mesh.h"
#include "core/shape/shape.h"

namespace passung::truth {

/// A solid whose distances are exact: of its triangles, or the closed form of a shape whose triangles are within
/// `chord_error` [m] of it. The mesh and the shape must outlive it.
struct Solid {
    const ExactMesh& mesh;
    const shape::Shape* shape = nullptr;  // none: the triangles themselves are meant
    double chord_error = 0.0;             // 0 without a shape
    double signedDistance(const Vec3& p) const;
};

/// Smallest signed distance of a surface from a solid: it lies in [value - uncertainty, value] [m].
struct SmallestDistance {
    double value = 0.0;
    double uncertainty = 0.0;
};

inline constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

/// The triangles of a surface in a tree of spheres: truth about how it lies to a solid, from exact distances to the
/// solid; nothing of the contact core. A branch is left out only where its sphere proves that it changes
/// nothing. @pre of all functions: `solid` is watertight, `X_FS` (surface to solid) finite.
class SurfaceTree {
public:
    explicit SurfaceTree(const ExactMesh& surface);

    /// By branch and bound over the whole surface, best first, until `uncertainty` ≤ `resolution` + chord error [m], or
    /// until `max_pieces` of the surface were looked at: faces that lie along each other take very long to tell apart.
    SmallestDistance smallestDistance(const Solid& solid, const Pose& X_FS, double resolution,
                                      std::size_t max_pieces = kNoLimit) const;

    /// Area-weighted penalty, the integral itself:
    ///   F = -κ ∫ p n dA,  T = ∫ (x - o) × dF,   p = max(0, -φ), o the origin of the surface's frame; axes of the
    ///   solid.
    /// By the midpoint rule over triangles cut until no edge is longer than `longest_edge` L [m]: on smooth surfaces
    /// the error falls as L².
    Wrench penaltyWrench(const Solid& solid, const Pose& X_FS, double area_stiffness, double longest_edge) const;

private:
    struct Node {
        Vec3 centre;
        double radius;  // of a sphere around all triangles below
        std::uint32_t first, end;
        std::uint32_t right = 0;  // 0: leaf; the left child follows its parent
    };
    std::uint32_t grow(std::uint32_t first, std::uint32_t end);

    std::vector<Corners> triangles_;  // in tree order
    std::vector<Node> nodes_;
};

}  // namespace passung::truth
