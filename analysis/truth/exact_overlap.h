#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/truth/surface_pieces.h"
#include "analysis/truth/triangle_boxes.h"
#include "core/base/types.h"
#include "core/geometry/mesh.h"
#include "core/scene/scene.h"
#include "core/shape/shape.h"

namespace passung::truth {

struct GrownShape;

/// How deep two parts reach into each other: the largest depth of any point of either surface in the other solid. It
/// lies in [depth, bound] [m], of shapes give or take the chord errors of their triangles; depth is that of `point`,
/// found and not merely possible.
struct Overlap {
    double depth = 0.0;
    double bound = 0.0;
    Vec3 point = Vec3::Zero();  // in the frame that the poses are in
    std::size_t pieces = 0;     // of surfaces that were looked at
};

/// What a search may leave open.
struct OverlapEffort {
    double tolerance = 2e-6;  // of the depth [m], > 0
    double share = 0.0;       // of the depth, besides the tolerance, ≥ 0
    double ignore = 0.0;  // depths up to it need not be told from 0 [m], ≥ 0; to prove that surfaces which lie along
                          // each other do not overlap takes the longer the less it is
    std::size_t most_pieces = 200'000;  // then `bound` is what was proven by then
};

/// One part: its surface as triangles, its inside by the closed form of a shape or the winding number of a mesh. A
/// mesh with gaps has the inside of its winding number; a sheet has none. Nothing of the contact core is asked.
class OverlapBody {
public:
    /// A shape, its triangles at most `chord_error` [m] off the true surface.
    OverlapBody(const shape::Shape& shape, double chord_error);
    /// @pre at least one triangle, finite vertices.
    explicit OverlapBody(const geometry::TriangleMesh& mesh);
    /// All points within `by` [m] of a shape, in the frame of `grown` (grown_shape.h), without a surface.
    OverlapBody(const shape::Shape& shape, const GrownShape& grown, double by);

    /// Those of a shape are made when first asked for. Thread-safe.
    const TriangleBoxes& surface() const;
    /// Empty for a mesh, and for kinds of shapes that have none.
    const SurfacePieces& pieces() const { return pieces_; }
    bool isShape() const { return shape_ != nullptr; }
    /// @pre isShape()
    const shape::Shape& shape() const { return *shape_; }
    double chordError() const { return chord_error_; }  // as reached [m]
    bool hasInside() const;
    /// Positive outside [m]. @pre hasInside().
    double signedDistance(const Vec3& p) const;
    /// No point of the hull of `corners` is deeper than this [m]; `middle` near its middle. Of a mesh nothing is known
    /// at once: infinite.
    double deepestAtOnce(std::span<const Vec3> corners, const Vec3& middle) const;
    /// Of whatever has this extent about the z axis of the shape. @pre isShape().
    double deepestOver(const AxialExtent& extent) const;
    /// The same with `phi`, the signed distance of the middle.
    double deepestOver(std::span<const Vec3> corners, const Vec3& middle, double phi) const;
    /// Is the hull of `corners` proven to be no deeper than `enough` [m]? Of a mesh never: that would take too long.
    bool isShallow(std::span<const Vec3> corners, const Vec3& middle, double enough) const;
    /// The same of a convex flat piece; at most 8 corners, in turn.
    double deepestOverPiece(std::span<const Vec3> corners, const Vec3& middle, double phi) const;
    /// Is all of a flat piece outside? False where that cannot be told at once.
    bool isOutside(std::span<const Vec3> piece, double phi) const;

private:
    bool isMetBy(std::span<const Vec3> piece) const;

    struct Core {
        shape::Shape shape;
        double lift, by;  // [m]
    };

    std::unique_ptr<const shape::Shape> shape_;  // none: a mesh
    std::optional<Core> core_;                   // of one that was grown
    SurfacePieces pieces_;
    double asked_chord_ = 0.0, chord_error_ = 0.0;  // [m]
    mutable std::once_flag made_;
    mutable std::unique_ptr<const TriangleBoxes> surface_;
};

/// The overlap of A and B, by branch and bound over both surfaces, the deepest possible piece first: of each piece the
/// depth of its middle, and a bound by the radius of its hull and by convex sets outside the solid. @pre poses finite.
///   A torus is all points within the radius t of its tube of a circle. While no point of that circle is in the other
/// solid S, let m be the least distance of the circle from S. Then no point of the torus is deeper in S than t - m, nor
/// any of S in the torus, and the point of S that is nearest to the circle is as deep: the overlap is t - m. So only
/// the circle is looked at, in the solid of all points within t of S. (Own.)
Overlap overlapOf(const OverlapBody& a, const Pose& X_WA, const OverlapBody& b, const Pose& X_WB,
                  const OverlapEffort& search = {});

/// Do any two triangles of A and B meet? (triangleMeets: touching is none.)
bool surfacesMeet(const OverlapBody& a, const Pose& X_WA, const OverlapBody& b, const Pose& X_WB);

/// Bodies of parts, each made once: of shapes with triangles within `chord_error` [m], or as near as tessellation gets.
class OverlapBodies {
public:
    struct Boxed {
        std::shared_ptr<const OverlapBody> body;  // shared_ptr: scenes that come and go share a body
        geometry::Bounds box;                     // part frame, what the mesh is off the surface included
    };

    explicit OverlapBodies(double chord_error = 5e-7) : chord_error_(chord_error) {}
    const Boxed& of(const scene::Part& part);

private:
    double chord_error_;
    std::map<std::string, Boxed> bodies_;
};

/// The held parts of a scene against all others.
class SceneOverlap {
public:
    /// The scene and `bodies` may go.
    SceneOverlap(const scene::Scene& scene, OverlapBodies& bodies);

    bool hasObstacles() const { return parts_.size() > 1; }
    /// Puts a part elsewhere than where it starts. `part`: its number in the scene.
    void place(std::size_t part, const Pose& X_W) { parts_[part].X_W = X_W; }
    /// With the part that the first hand begins with at X_WG. @pre there is one
    Overlap at(const Pose& X_WG, const OverlapEffort& search = {}) const;
    /// The deepest of all pairs of which one is among `held`, where all parts were placed.
    Overlap of(std::span<const std::size_t> held, const OverlapEffort& search = {}) const;
    /// Do the held part's triangles meet any obstacle's?
    bool surfacesMeet(const Pose& X_WG) const;

private:
    struct Part : OverlapBodies::Boxed {
        Pose X_W;
    };
    /// By a ball about one part's box and the box of the other, either way.
    static bool areApart(const Part& a, const Pose& X_WA, const Part& b, const Pose& X_WB);
    /// Adds the overlap of a pair to what was found of others.
    static void add(const Part& a, const Pose& X_WA, const Part& b, const OverlapEffort& search, Overlap& deepest);

    std::vector<Part> parts_;
    std::size_t held_;
};

}  // namespace passung::truth
