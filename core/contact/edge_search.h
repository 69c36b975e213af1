#pragma once

#include "core/contact/contact_query.h"
#include "core/shell/edge_curves.h"

namespace passung::contact {

/// queryContacts for the edges of a shell in place of its points: between two samples of an edge, where it comes
/// nearest to the obstacle or dips deepest into it, lies a contact that no sample shows. (Own.)
///   Along an edge p(t), φ* = min over t of φ(p(t)). When the parts move by u, it changes by that of φ at the place
/// where it is least (envelope theorem); where φ has a kink there, the ridge between two faces of the obstacle, by
///   g = λ g₋ + (1 - λ) g₊  with g · p'(t) = 0:
/// of all mixtures of the two faces' gradients the one along which sliding on the edge changes nothing, for two edges
/// the normal to both. So φ* and g make a contact like any other.
///   Found like this: φ at all stations of the stretches that come near; around each that is lower than both beside it,
/// tangents to φ(t) from both sides, whose crossing is looked at next (Kelley 1960), until it lies no deeper than
/// kAlong · cell below what is known. Of a φ that is convex along the edge (a convex obstacle) nothing is missed; where
/// it is not, what is smaller than a gap between stations may be.
/// A search with a `pause` may have a budget: when that ends the same call goes on where it stopped, by one stretch at
/// least, until nothing is left (QueryRequest::pauses).
/// Appends to `manifold`; of `request` spheres, facing, load and refine mean nothing here. The search is left out under
/// another budget, in modes whose values jump from voxel to voxel, and for fields of cells of one size: refined to no
/// tolerance, they blunt the obstacle's edges by more than lies between two samples. `lower_bound` is φ*, as far as it
/// was found. A stretch counts as a node,
/// if it is not passed over: `known` is of these stretches in this field, as in queryContacts. rt-safe; the number of
/// steps is bounded by the number of stations.
struct EdgePause {
    bool open = false;
    std::uint32_t next = 0;  // stretch
    QueryAnswer answer;
};
QueryAnswer searchEdges(const field::DistanceField& field, const Pose& X_WF, const shell::EdgeCurves& edges,
                        const Pose& X_WS, const QueryRequest& request, ContactManifold& manifold,
                        Certificates* known = nullptr, EdgePause* pause = nullptr) noexcept;
inline constexpr double kAlong = 5e-4;
inline constexpr int kEdgeSteps = 12;

}  // namespace passung::contact
