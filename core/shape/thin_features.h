#pragma once

#include <string>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/geometry/triangle_tree.h"
#include "core/shape/shape.h"

namespace passung::shape {

/// What stands out of a solid, or all of it, and is thin.
enum class FeatureKind {
    Pin,     // thin along two axes
    Wall,    // thin along one: a fin, a rib, a rim, a floor, a whole plate
    Edge,    // two faces that meet at an acute angle
    Tip,     // a point, of a cone for instance
    Relief,  // thin, on a surface without flat or developed faces: a scan's
};
const char* featureName(FeatureKind kind);  // "pin", "wall", …: for people

struct ThinFeature {
    FeatureKind kind = FeatureKind::Wall;
    double size = 0.0;  // thickness [m]; of an edge or tip that of its end, about as far in as the ball asked for
    Vec3 place = Vec3::Zero();  // a point of it, part frame [m]; of a shape its origin
};

/// Which features count.
enum class ThinIn {
    Points,  // those with a free end, that may slip between the points of a surface that is pressed on them
    Field,   // all: what interpolation smooths away
};

/// What a search may cost, the same on every machine, and what it left out.
struct SearchLimit {
    std::size_t most_work = 20'000'000;  // questions asked of the tree; half a minute or so
    std::size_t work = 0;                // of them those that it asked; some tens of places are looked at anyway
    std::size_t left_out = 0;            // places that it did not come to; 0 but for thousands of thin ones
};

/// Features of a solid in which no ball of `radius` [m] has room: those that surfaces sampled so that no place is
/// farther than `radius` from a sample do not feel. (Own.)
///   O the solid, H another whose surface has a sample within ρ of each of its places, every sample outside O.
///   A ball with its centre c in O and a radius R > ρ, all of it in O, contains no sample. So the surface of H stays
///   R - ρ > 0 away from c; and as the parts move, c cannot get into H without crossing that surface. Hence c is
///   outside H, and a point q of O is in H no deeper than |q - c|: no deeper than
///       e(q) = distance of q from  { c : φ_O(c) ≤ -ρ },
///   less ρ where c is straight below q. On flat or blunt surface e = ρ; at the edge of a block √2 ρ, at its corner
///   √3 ρ, at the edge of a wedge of angle 2α and the tip of such a cone ρ / sin α. Of a pin or fin thinner than 2ρ the
///   set is empty: e is its length, which nothing limits.
///   Told are pins and fins with e > kFelt ρ, and edges and tips (thicker the farther in) with e > kBlunt ρ: of less
///   than 27.5°. The sharp corners of a right tetrahedron, e = 3.99 ρ, are none of them.
/// Shapes: closed forms. Meshes: q are the vertices, points along sharp edges that stand out and, for ThinIn::Field,
/// middles of triangles; c is searched around each. A mesh without a volume is a wall of no thickness. The search ends
/// after `limit`'s work.
std::vector<ThinFeature> thinFeatures(const Shape& shape, double radius, ThinIn where);
std::vector<ThinFeature> thinFeatures(const geometry::TriangleMesh& mesh, const geometry::TriangleTree& tree,
                                      double radius, ThinIn where, SearchLimit* limit = nullptr);
inline constexpr double kFelt = 1.9;
inline constexpr double kBlunt = 4.2;

}  // namespace passung::shape
