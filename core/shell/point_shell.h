#pragma once

#include <cstdint>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::shell {

/// One sample of a surface; part frame, metres.
struct SurfacePoint {
    Vec3 position;               // each coordinate is exactly a float
    Vec3 normal;                 // unit, outward: the mean of the patch that the point stands for
    double area = 0.0;           // of that patch [m²]; 0 for samples on edges and corners, which represent no area
    std::uint32_t triangle = 0;  // of the mesh, that the position lies on
};

/// Blue-noise samples of a surface with the area that each stands for, plus samples along sharp edges and at corners
/// (a rim must not slip between points). Those carry no area: the patches of the faces reach up to the edge already,
/// and a wrench summed over the faces would count it twice.
struct PointShell {
    std::vector<SurfacePoint> points;
    double total_area = 0.0;    // [m²], equals the mesh's area
    double cover_radius = 0.0;  // no point of the surface is farther than this from a sample [m]
    double rounding = 0.0;      // no sample is farther than this from the surface: positions are rounded to floats [m]
};

inline constexpr double kEdgeShare = 0.5;  // spacing of samples on edges, per spacing

/// Samples `mesh` about `spacing` [m] apart; the same mesh and spacing give the same points.
///   Candidates: the triangles, cut until no edge is longer than 0.7 spacings; each candidate is a cut triangle's
///   centroid with its area. A Poisson-disk subset of them, relaxed by Lloyd's iteration, becomes the samples; a
///   candidate belongs to the nearest sample whose normal is within 60° of its own, and becomes a sample if there is
///   none, so that no patch joins two sides of a wall. At last a sample moves to the point of the surface nearest to
///   its patch's centroid, if that faces the whole patch: a sum over the patches is then exact for whatever changes
///   linearly across each of them.
/// A patch's area is the sum of its candidates' areas and its normal that of the summed area vectors, so that
/// Σ area = area of the mesh and Σ area · normal = 0 on a closed mesh up to the patches' curvature.
/// Time and memory grow with the number of candidates, about eight a sample on large triangles.
PointShell samplePoints(const geometry::TriangleMesh& mesh, double spacing);

}  // namespace passung::shell
