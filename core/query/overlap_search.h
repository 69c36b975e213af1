#pragma once

#include <queue>

#include "core/field/distance_field.h"
#include "core/geometry/triangle_distance.h"
#include "core/geometry/triangle_tree.h"
#include "core/query/search_progress.h"

namespace passung::query {

/// A solid with what tells inside from outside; its frame.
struct MeshSolid {
    const geometry::TriangleTree& triangles;
    const field::DistanceField& field;
    double slack;     // of the field's bounds against the triangles [m]
    double rounding;  // of coordinates [m]

    bool isInside(const Vec3& p) const;

    /// φ at `p`, exactly, is offered to the search; the point of the surface next to it.
    geometry::ClosestPoint look(const Vec3& p, SearchProgress& progress) const;
};

/// Depth of triangles in a solid A, by branch and bound: the piece that may be deepest is looked at first, and cut
/// until it is nowhere deeper than the tolerance allows: midway between the faces that lie nearest to its middle and to
/// a corner, for there the ways out part, or else across its longest edge. Three bounds of a piece T say so:
///   - A sphere. φ_A is 1-Lipschitz: φ_A ≥ φ_A(c) - r, c a point of T and r the distance of its farthest corner.
///   - A triangle t of A. A point inside is no farther from A's surface than from t, and the distance from t is convex:
///     no point of T is deeper than the farthest of its corners is from t.
///   - A way out. A line from inside A to a point outside crosses A's surface: a point that a step v takes outside is
///   no
///     deeper than |v|. If T + v meets no triangle of A and one of its points is outside, all are, and no point of T is
///     deeper than |v|. Here |v| is what is known of the depth and the tolerance, along the way out at the middle of T
///     or at the deepest point known. T may be as large as A's surface is bent by less than the tolerance across it,
///     however shallow it lies; faces along each other take one step.
class OverlapSearch {
public:
    /// Both outlive this.
    OverlapSearch(const MeshSolid& solid, SearchProgress& progress) : solid_(solid), progress_(progress) {}

    /// `lower`: of φ_A on the triangle [m].
    void add(const geometry::TriangleCorners& triangle, double lower) { pieces_.push({lower, triangle}); }

    /// Looks at pieces until all may be left out or the steps end.
    void run();

private:
    struct Piece {
        double lower;  // of φ_A on it [m]
        geometry::TriangleCorners corners;
        bool operator<(const Piece& other) const { return lower > other.lower; }
    };
    /// Of A, in the plane of a triangle.
    struct Face {
        Vec3 point, normal;
    };
    Face faceAt(const geometry::ClosestPoint& near) const;
    bool isOutsideAfter(const geometry::TriangleCorners& piece, const Vec3& step) const;
    bool findsWayOut(const Piece& piece, const Vec3& middle, const geometry::ClosestPoint& near);
    double lowerBound(const Piece& piece);
    void split(const Piece& piece);

    const MeshSolid& solid_;
    SearchProgress& progress_;
    std::priority_queue<Piece> pieces_;
    // Of the piece looked at last: what lies nearest to its middle and to the corner farthest from that.
    Face at_middle_{}, at_corner_{};
};

}  // namespace passung::query
