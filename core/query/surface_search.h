#pragma once

#include <cstdint>
#include <memory>

#include "core/base/types.h"
#include "core/geometry/triangle_tree.h"
#include "core/query/triangle_spheres.h"
#include "core/scene/part.h"

namespace passung::query {

/// What is proven about  m = min φ_A over the triangles of B,  A and B two meshes; A's frame.
struct SurfaceBounds {
    double lower = 0.0, upper = 0.0;  // m lies between them [m]
    Vec3 point = Vec3::Zero();        // of B's surface, where φ_A is `upper`
    Vec3 normal = Vec3::Zero();       // unit, out of A there; zero on the surface itself
    int steps = 0;                    // spheres and pieces looked at
};

/// Exact distances and depths of one mesh against another, by branch and bound over the triangles of B; with the field
/// of A for what is far, with the triangles of A for what is near. May allocate.
///   A sphere around triangles (centre c, radius r) holds no point with  φ_A < φ_low(c) - r - h,  φ_low the field's
/// lower bound and h the chord error of A's mesh against the shape that the field was sampled from.
///   Outside, the field's bounds at its corners tell more of a triangle (leastDistance). What remains has its distance
/// from A's triangles found exactly: first the triangle that seems nearest, which brings the upper bound down, then all
/// others that may be nearer than that less the tolerance. A triangle of B that does not meet A's surface lies on one
/// side of it.
///   Inside or across, depth is sought, piece by piece of those triangles: see OverlapSearch.
class SurfaceSearch {
public:
    static constexpr int kLeastSteps = 32;  // fewer lead nowhere

    /// @pre `a.field` exists, bounds proven; both outlive this.
    SurfaceSearch(const scene::Part& a, const scene::Part& b);
    ~SurfaceSearch();

    /// `p_AB`: a point of B's surface, up to `rounding` [m], at which to begin (B's frame). Ends where upper - lower ≤
    /// `tolerance` [m] or before there could be more than `most_steps`; the bounds hold either way.
    SurfaceBounds bounds(const Pose& X_AB, const Vec3& p_BP, double rounding, double tolerance, int most_steps);

private:
    struct Search;
    struct Waiting;
    struct Scratch;

    const scene::Part& a_;
    geometry::TriangleTree triangles_;  // of A
    TriangleSpheres spheres_;           // of B
    std::uint64_t round_ = 0;
    std::unique_ptr<Scratch> scratch_;
};

}  // namespace passung::query
