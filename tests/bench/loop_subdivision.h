#pragma once

#include "core/geometry/mesh.h"

namespace passung::bench {

/// One step of Loop's subdivision (Loop 1987): every triangle of a closed mesh becomes four, smoother than before.
///   vertex of valence n:  v' = (1 - n β) v + β Σ neighbours,  β = (5/8 - (3/8 + cos(2π/n)/4)²) / n
///   edge (a, b) between c and d:  3/8 (a + b) + 1/8 (c + d)
/// Limit case: on a regular mesh in one plane nothing moves. @pre every edge has exactly two triangles.
geometry::TriangleMesh subdivideLoop(const geometry::TriangleMesh& mesh);

}  // namespace passung::bench
