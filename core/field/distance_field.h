#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/field/field_mode.h"
#include "core/field/instructions.h"
#include "core/field/surface_block.h"
#include "core/geometry/mesh.h"

namespace passung::field {

/// Exact geometry that a field is sampled from; part frame, metres. Called from several threads.
struct DistanceSource {
    geometry::Bounds bounds;                      // of the surface
    double area = 0.0;                            // of it [m²]; 0: unknown
    std::function<double(const Vec3&)> distance;  // unsigned, exact
    std::function<bool(const Vec3&)> inside;      // never called for an open sheet
    bool open_sheet = false;                      // no inside: two-sided, thickened by one cell on each side
    bool closed = false;  // `inside` changes at the surface only, so that the signed distance is 1-Lipschitz
    /// All of a block of 8³ cells at once, from its first corner and the edge of a cell; optional, faster.
    std::function<void(const Vec3&, double, SurfaceBlock&)> block;
    /// Bounds what trilinear interpolation errs by in the cells of an octant of a block, whose nodes hold exact values
    /// [m]: from the block, its first corner, the edge of a cell, the octant (bits 1: x, 2: y, 4: z); optional.
    /// Only cells with a |node value| up to the last argument need count.
    std::function<double(const SurfaceBlock&, const Vec3&, double, std::size_t, double)> error_bound;
    struct Nearest {
        double distance;  // unsigned
        Vec3 point;
    };
    /// The nearest point of the surface, searched no farther than the second argument [m] (then that is the distance,
    /// and the point is meaningless); optional, faster.
    std::function<Nearest(const Vec3&, double)> nearest_within;
    /// Unsigned and exact in a cell of a block, from the triangles that it names there; with `block`, or none.
    std::function<double(const Vec3&, std::span<const std::uint32_t>)> distance_to;
    /// Points of the surface, the tips of its smallest features among them; optional: see FieldAccuracy.
    std::vector<Vec3> landmarks;
};

/// How a field refines its bricks.
struct FieldAccuracy {
    double tolerance = 0.0;           // of the trilinear value [m]; 0 = cells of the size asked for in all of the band
    double largest_cell = 0.0;        // refinement begins here [m]; 0 = at `cell`; else `cell` times a power of two
    double depth = 0.0;               // the tolerance holds up to this far from the surface [m]; deeper: a tenth of φ
    double reach = 0.0;               // of the coarse grid beyond the band [m]; 0 = one part size
    std::size_t bytes = kFieldBytes;  // refinement ends before the bricks need more
    // Told which level of cells is sampled, from 0, and how much of it is; by any thread, but one at a time.
    std::function<void(int level, double share)> told = {};

    static constexpr std::size_t kFieldBytes = std::size_t{256} << 20;
};

/// Value of the interpolated field.
struct FieldSample {
    double phi = 0.0;              // signed distance [m], positive outside
    Vec3 gradient = Vec3::Zero();  // of the interpolant [-]; about unit length, points out of the part
};

/// How what is read of a field (FieldMode::Trilinear) changes along a way; see DistanceField::change.
struct ReadChange {
    double within = 0.0;    // values beyond this say nothing [m]; 0: nothing is known
    double steepest = 0.0;  // per metre
    double jump = 0.0;      // besides, of a way shorter than a brick [m]

    /// No point within `way` [m] of one that was read as `value` is read below this, if this is not below 0.
    double leastAround(double value, double way) const noexcept {
        return std::min(value, within) - steepest * way - jump;
    }
    /// The same from above, if that is below `within`; else infinity.
    double mostAround(double value, double way) const noexcept {
        const double most = value + steepest * way + jump;
        return most < within ? most : std::numeric_limits<double>::infinity();
    }
};

/// Signed distance field: exact distances at the nodes of bricks of 8³ cells near the surface (9³ samples, shared
/// faces) and of a coarse grid, whose cell is one brick, everywhere else. Where a brick errs too much (rims, edges,
/// curved faces), an octant of it is replaced by a brick with cells of half the size, and so on. (The thesis's
/// voxelmap; its V is -φ.) Bricks hold 16-bit numbers between their least and largest value: they are off by at most
/// 1/131 000 of that span, and from brick to brick the interpolant may jump by as much, between cells of two sizes by
/// the tolerance. Built once, then const; every query is rt-safe and thread-safe.
class DistanceField {
public:
    static constexpr int kBrickCells = 8;
    static constexpr int kBrickNodes = kBrickCells + 1;
    static constexpr int kMostLevels = 12;  // of refinement: cells down to 1/4096 of the largest

    /// Samples `source` with cells of edge `cell` [m]. Bricks cover all points within `band` [m] of the surface; the
    /// coarse grid reaches one part size beyond it if nothing else is said. Errors: a field of more than 2 GiB.
    ///   With a tolerance, octants of bricks are refined where the trilinear value errs by more than it, at most
    /// kMostLevels times. Measured are: exact distances at nine points of every cell whose second differences admit
    /// such an error, and the landmarks, where φ = 0. Not measured: behind the offset of an open sheet, and where the
    /// sign jumps in a hole that was left open.
    static Result<DistanceField> build(const DistanceSource& source, double cell, double band,
                                       const FieldAccuracy& accuracy = {});

    /// φ and its gradient at `p` (part frame). Outside the grid φ is the distance to the part's box (a lower bound).
    /// `inward`: unit normal, into its part, of the surface that asks; FieldMode::Layered projects on it.
    FieldSample sample(const Vec3& p, FieldMode mode, const Vec3& inward = Vec3::Zero()) const noexcept;

    /// A frame S that stands at X_FS in the part frame F, folded into what sampleMany and lowerBounds compute with.
    struct Placement {
        Pose X_FS;
        std::array<double, 9> turn;  // to coordinates in largest bricks, row by row
        std::array<double, 3> shift;
        std::array<double, 3> low, high;  // of the index; a coordinate outside is drawn to its border
        double cubes;                     // of the index along a largest brick
        std::array<std::int32_t, 3> first;
        std::int32_t row, slab;
    };
    Placement place(const Pose& X_FS) const noexcept;

    /// φ (FieldMode::Trilinear) at many points x, y, z of the frame S. In single precision within a brick: next to
    /// sample() it is off by at most 2⁻²⁰ of the span of the brick's values and 2⁻²³ of φ. The same bits whatever the
    /// instructions; `phi` is as long as the others.
    void sampleMany(const Placement& S, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                    std::span<float> phi, Instructions instructions = bestInstructions()) const noexcept;

    /// lowerBound() at many points of the frame S, less what single precision may add: never above the true φ.
    void lowerBounds(const Placement& S, std::span<const float> x, std::span<const float> y, std::span<const float> z,
                     std::span<float> bound, Instructions instructions = bestInstructions()) const noexcept;

    /// A rigorous lower bound of the true φ at `p`; cheaper than sample() by the gradient.
    ///   No holes, the larger of two, with the trilinear weights w and S = Σ w_i |c_i - p|² = edge² Σ_axis u (1 - u):
    ///     near the surface: φ is linear but for a function with Lipschitz constant k ≤ 1 (errorBound), and
    ///     interpolation is exact for the linear part,  φ(p) ≥ Σ w_i (φ_i - k |c_i - p|) ≥ Σ w_i φ_i - k √S, and of
    ///     shapes ≥ Σ w_i φ_i - e; far from it: d² - |p|² is the least of linear functions of p (d the distance to the
    ///     solid or sheet), hence concave and nowhere below its interpolant,  d(p)² ≥ Σ w_i d_i² - S. (For a convex
    ///     part d - bound ≤ S/d.)
    ///   Holes left open (boundProven() is false): where the surface goes on is unknown, so is the sign between two
    ///   nodes. All that is certain of every surface that contains the triangles is |φ(p)| ≤ their distance d(p), and
    ///   d(p) ≤ min_i (|φ_i| + |c_i - p|); the bound is the negative of that, and a query prunes next to nothing.
    double lowerBound(const Vec3& p) const noexcept;

    /// A rigorous bound of |sample(p).phi - true φ(p)| [m], offset of an open sheet not included.
    ///   No holes, trilinear: |interpolant - φ(p)| ≤ k Σ w_i |c_i - p|, where φ less some linear function has the
    ///   Lipschitz constant k in the cell: 1 always; on closed meshes what the normals of the nearest triangles span.
    ///   And ≤ e, which is known for shapes (boundInterpolation), up to the depth of FieldAccuracy from the surface.
    ///   Both are the largest of the cells of an octant. Layered, whatever the normal: s/2 from rounding, |C - p| for φ
    ///   and as much for the projection. The others: the bound of trilinear and what the two values differ by. Holes
    ///   left open: |interpolant| + the upper bound of d(p) above.
    double errorBound(const Vec3& p, FieldMode mode) const noexcept;

    /// How sample() and sampleMany() change, known of a field with bricks of one size and no holes.
    ///   Stored numbers are off by half a step s of their brick at most and their exact values 1-Lipschitz: along an
    /// axis an interpolant rises by at most 1 + s/edge, along any way by √3 times that. From brick to brick it jumps by
    /// a step at most.
    ///   Outside the bricks, where cells are large, nothing of that holds. But there all values, and those of bricks at
    /// the border, have a size of at least m, on each side of the surface with one sign: both are looked up. On a way
    /// from a value v > 0 to one below L, 0 ≤ L < min(v, m), the last piece within bricks, and be it all of the way,
    /// begins at v or at m or above, so that the way is at least  (min(v, m) - L - jumps) / steepest.
    ///   Limit cases: cells of several sizes, or holes → `within` = 0, and nothing is told.
    const ReadChange& change() const { return change_; }

    /// False if the geometry has holes that were left open: see lowerBound and errorBound.
    bool boundProven() const { return bound_proven_; }

    /// The cell that was asked for [m], about what the tolerance takes on smooth surface. What scales with the field's
    /// resolution but must not creep at rims (steps of a god object) takes this one.
    double cell() const { return cell_; }
    /// The smallest cell anywhere [m].
    double finestCell() const { return finest_cell_; }
    /// False if refinement ended because of FieldAccuracy::bytes: then the tolerance is exceeded somewhere.
    bool refined() const { return refined_; }
    /// How far the zero level lies in front of an open sheet's surface, on both sides [m]; 0 for solids.
    double sheetOffset() const { return sheet_offset_; }
    const geometry::Bounds& bounds() const { return surface_bounds_; }
    std::size_t brickCount() const { return bricks_.size(); }
    std::size_t memoryBytes() const;

    /// The field as bytes, the same on every machine, and back, the same bits; nothing if the bytes hold no field.
    std::string toBytes() const;
    static std::optional<DistanceField> fromBytes(std::string_view bytes);

private:
    static constexpr std::size_t kBrickSamples = std::size_t{kBrickNodes} * kBrickNodes * kBrickNodes;

    static constexpr std::size_t kIndexPerBrick = 32;  // the index is not larger than so many numbers a brick

    struct Builder;  // distance_field_builder.h
    struct Cell;     // a spot and the eight corners
    template <class Number>
    struct Lattice;  // distance_field_modes.cpp

    struct Brick {
        double low, step;                   // φ = low + step · stored number
        std::array<std::int32_t, 8> child;  // brick that replaces each octant (bits 1: x, 2: y, 4: z); -1: none
        std::int32_t level;                 // 0: largest cells
        bool refined;                       // has a child
    };
    using Slacks = std::array<std::uint8_t, 8>;  // of each octant: k in 255ths, of shapes √(e / cell); see errorBound
    /// What sampleMany needs of a brick, close together.
    struct Head {
        float low, step;
        std::int32_t first;  // of its samples
        float cells;         // along a largest brick; negative: has a child
    };

    static constexpr std::size_t kBrickBytes = sizeof(Brick) + sizeof(Slacks) + sizeof(Head) +
                                               kBrickSamples * sizeof(std::uint16_t) +
                                               kIndexPerBrick * sizeof(std::int32_t);

    /// The smallest brick that holds a point.
    struct CellPlace {
        std::size_t brick;
        int level;                // 0: largest cells
        unsigned octant;          // of the brick
        std::array<int, 3> cell;  // counted from the corner of the largest brick, in cells of this level
    };
    /// The cell around a point, in the brick or coarse grid that holds it.
    struct Spot {
        std::array<int, 3> at;     // the cell
        std::array<int, 3> cells;  // of the brick or grid, per axis
        std::size_t first;         // number of the brick
        Vec3 u;                    // local coordinates in [0, 1]³
        double edge;               // [m]
        double inverse_edge;       // [1/m]
        double low, step;          // φ = low + step · stored number [m]
        double slack, most;        // k, and e if |φ| ≤ bounded_within_ [m]: see errorBound
        bool in_brick;             // else on the coarse grid, where floats are stored
    };
    CellPlace descend(std::int32_t root, const Vec3& in_root) const noexcept;  // in_root in [0, 1)³
    bool find(const Vec3& p, Spot& spot) const noexcept;
    bool locate(const Vec3& p, Cell& cell) const noexcept;
    FieldSample sampleOutside(const Vec3& p) const noexcept;
    FieldSample sampleAt(const Spot& spot, FieldMode mode, const Vec3& inward) const noexcept;
    bool soundGrid() const;
    bool soundBricks() const;
    template <class Take>
    void takeCorners(const std::array<int, 3>& cell, Take take) const;
    template <class Take>
    void takeBorder(std::size_t brick, const std::array<int, 3>& side, Take take) const;
    double leastOutsideBricks() const;
    void measureChange();
    void fillIndex();
    void indexBrick(std::int32_t id, const std::array<int, 3>& place);
    void enterIndex(std::int32_t id, const std::array<int, 3>& place, int finer);
    struct Block;  // distance_field_many.cpp
    double boxDistance(const Vec3& p) const noexcept;
    double rounding(const Cell& cell) const noexcept;
    double bound(const Cell& cell, double way, double phi) const noexcept;
    double farthestSurface(const Cell& cell) const noexcept;
    std::size_t coarseNode(int x, int y, int z) const noexcept;
    std::size_t coarseCell(int x, int y, int z) const noexcept;

    geometry::Bounds surface_bounds_;
    Vec3 origin_ = Vec3::Zero();         // of the coarse grid
    std::array<int, 3> coarse_cells_{};  // per axis
    double cell_ = 0.0;                  // asked for [m]
    double largest_cell_ = 0.0;          // of unrefined bricks [m]
    double finest_cell_ = 0.0;
    double brick_edge_ = 0.0;  // coarse cell [m]
    double inverse_brick_edge_ = 0.0;
    double sheet_offset_ = 0.0;
    double arithmetic_ = 0.0;  // what rounding in double precision may add up to [m]
    bool bound_proven_ = true;
    double bounded_within_ = -1.0;  // [m]; ≥ 0: Slacks hold e, not k, of points with |φ| up to this
    bool refined_ = true;
    std::vector<float> coarse_;                // nodes
    std::vector<std::int32_t> brick_of_cell_;  // -1: none
    std::vector<Brick> bricks_;
    std::vector<Slacks> slacks_;          // of each brick
    std::vector<std::uint16_t> samples_;  // brickCount × 9³, x fastest

    /// For each cube with the edge of a brick of one level, the smallest brick of that level or above around it; -1:
    /// none. Spares most points the way down from the largest brick.
    struct Index {
        int level = 0;
        std::array<int, 3> low{}, size{};  // in cubes, from the corner of the coarse grid
        std::vector<std::int32_t> brick;   // x fastest
    };
    Index index_;

    std::vector<Head> heads_;
    ReadChange change_;
};

}  // namespace passung::field
