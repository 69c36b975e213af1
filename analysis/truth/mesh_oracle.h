#pragma once

#include <memory>

#include "analysis/truth/exact_mesh.h"
#include "core/base/result.h"
#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::truth {

/// How two solids lie to each other. FCL sees surfaces only: what lies wholly inside the other is free to it, so
/// containment is found by ray parity and named apart.
enum class Relation { Apart, SurfacesIntersect, BInsideA, AInsideB };

const char* toString(Relation relation);

/// Independent truth about two watertight meshes A and B: FCL's bounding volume hierarchies (OBBRSS) for intersection
/// and separation of the surfaces, own exact geometry for inside and depth. Nothing of core's
/// queries is used. Built once, then const. `X_AB` is the pose of B in A; a pose that is not finite is an error.
///
/// Limits: FCL gives no penetration depth for meshes (per-contact depths belong to triangle pairs and are far smaller),
/// and its distance of intersecting meshes is 0; hence depth() is computed here. Exact touching may count either way.
class MeshOracle {
public:
    /// @pre at least one triangle each, finite vertices.
    MeshOracle(const geometry::TriangleMesh& a, const geometry::TriangleMesh& b);
    ~MeshOracle();
    MeshOracle(MeshOracle&&) noexcept;
    MeshOracle& operator=(MeshOracle&&) noexcept;

    /// Does any triangle of A meet any of B? (FCL collide)
    Result<bool> surfacesIntersect(const Pose& X_AB) const;

    /// Smallest distance between the surfaces [m], also if one lies inside the other; 0 if they intersect. (FCL
    /// distance)
    Result<double> separation(const Pose& X_AB) const;

    /// @pre each mesh is one connected piece.
    Result<Relation> relation(const Pose& X_AB) const;

    /// Deepest point of B's surface inside A, in A's frame; see deepestPoint. For the other way swap A and B.
    Result<DeepestPoint> depth(const Pose& X_AB, double resolution) const;

    const ExactMesh& a() const { return exact_a_; }
    const ExactMesh& b() const { return exact_b_; }

private:
    struct Surfaces;
    std::unique_ptr<Surfaces> surfaces_;  // keeps FCL out of this header
    ExactMesh exact_a_, exact_b_;
};

}  // namespace passung::truth
