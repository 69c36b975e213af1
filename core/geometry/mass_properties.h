#pragma once

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::geometry {

/// What a rigid body of one density is to weight and motion, in the frame of its geometry.
struct MassProperties {
    double mass = 0.0;            // [kg]
    Vec3 centre = Vec3::Zero();   // of mass [m]
    Mat3 inertia = Mat3::Zero();  // about the centre, axes of the frame [kg·m²]
};

/// Of what closed triangles enclose.
/// Symbols: ρ density, o any point, a, b, c a triangle's corners from o, s = a + b + c, D = a · (b × c) six times the
/// signed volume of the tetrahedron (o, a, b, c); x from o.
/// Derivation: by the divergence theorem, applied to x, |x|² and so on, an integral over the body is the sum of those
/// over the tetrahedra, those that face away from o with a minus. Of one of them
///   ∫ dV = D/6,   ∫ x dV = D/24 s,   ∫ x xᵀ dV = D/120 (a aᵀ + b bᵀ + c cᵀ + s sᵀ).
/// With m = ρ V, r the centre from o and C = ρ ∫ x xᵀ dV - m r rᵀ:  I = tr(C) 1 - C.
/// Limit cases: triangles the other way round → mass and inertia negative, the same centre; no volume → all 0.
/// Invariants: the choice of o changes rounding alone (taken is the middle of the bounds); a cavity counts as none of
/// the body; what two solids share counts twice.
/// @pre closed triangles, outward orientation
MassProperties massOf(const TriangleMesh& mesh, double density);

/// Steiner: I + m (|d|² 1 - d dᵀ), d from the centre to `point` [kg·m²].
Mat3 inertiaAbout(const MassProperties& body, const Vec3& point);

/// Both as one rigid body, in the same frame; one of them may be a hole, of negative mass and inertia.
/// @pre the masses' sum is not 0
MassProperties together(const MassProperties& a, const MassProperties& b);

}  // namespace passung::geometry
