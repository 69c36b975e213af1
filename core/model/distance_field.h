#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/result.h"
#include "core/base/types.h"
#include "core/model/mesh.h"
#include "core/model/scene_spec.h"

namespace passung::model {

/// Exact geometry that a field is sampled from; part frame, metres. Called from several threads.
struct DistanceSource {
    Bounds bounds;                                // of the surface
    std::function<double(const Vec3&)> distance;  // unsigned, exact
    std::function<bool(const Vec3&)> inside;      // never called for an open sheet
    bool open_sheet = false;                      // no inside: two-sided, thickened by one cell on each side
    bool closed = false;  // `inside` changes at the surface only, so that the signed distance is 1-Lipschitz
};

/// Value of the interpolated field.
struct FieldSample {
    double phi = 0.0;              // signed distance [m], positive outside
    Vec3 gradient = Vec3::Zero();  // of the interpolant [-]; about unit length, points out of the part
};

/// Signed distance field: exact distances at the nodes of bricks of 8³ cells near the surface (9³ samples, shared
/// faces) and of a coarse grid, whose cell is one brick, everywhere else. (The thesis's voxelmap; its V is -φ.)
/// Built once, then const; every query is rt-safe and thread-safe.
class DistanceField {
public:
    static constexpr int kBrickCells = 8;
    static constexpr int kBrickNodes = kBrickCells + 1;

    /// Samples `source` with cells of edge `cell` [m]. Bricks cover all points within `band` [m] of the surface; the
    /// coarse grid reaches one part size beyond it. Errors: a field of more than 2 GiB.
    static Result<DistanceField> build(const DistanceSource& source, double cell, double band);

    /// φ and its gradient at `p` (part frame). Outside the grid φ is the distance to the part's box (a lower bound).
    FieldSample sample(const Vec3& p, FieldMode mode) const noexcept;

    /// A rigorous lower bound of the true φ at `p`; cheaper than sample() by the gradient.
    ///   No holes, the larger of two, with the trilinear weights w and S = Σ w_i |c_i - p|² = edge² Σ_axis u (1 - u):
    ///     near the surface: exact samples of a 1-Lipschitz function,  φ(p) ≥ Σ w_i (φ_i - |c_i - p|) ≥ Σ w_i φ_i - √S;
    ///     far from it: d² - |p|² is the least of linear functions of p (d the distance to the solid or sheet), hence
    ///     concave and nowhere below its interpolant,  d(p)² ≥ Σ w_i d_i² - S. (For a convex part d - bound ≤ S/d.)
    ///   Holes left open (boundProven() is false): where the surface goes on is unknown, so is the sign between two
    ///   nodes. All that is certain of every surface that contains the triangles is |φ(p)| ≤ their distance d(p), and
    ///   d(p) ≤ min_i (|φ_i| + |c_i - p|); the bound is the negative of that, and a query prunes next to nothing.
    double lowerBound(const Vec3& p) const noexcept;

    /// A rigorous bound of |sample(p).phi - true φ(p)| [m], offset of an open sheet not included.
    ///   No holes: |interpolant - φ(p)| ≤ Σ |w_i| |c_i - p| (+ |1 - Σ w_i| = 0).
    ///   Holes left open: |interpolant| + the upper bound of d(p) above.
    double errorBound(const Vec3& p, FieldMode mode) const noexcept;

    /// False if the geometry has holes that were left open: see lowerBound and errorBound.
    bool boundProven() const { return bound_proven_; }

    double cell() const { return cell_; }
    /// How far the zero level lies in front of an open sheet's surface, on both sides [m]; 0 for solids.
    double sheetOffset() const { return sheet_offset_; }
    const Bounds& bounds() const { return surface_bounds_; }
    std::size_t brickCount() const { return bricks_.size() / kBrickSamples; }
    std::size_t memoryBytes() const;

private:
    static constexpr std::size_t kBrickSamples = std::size_t{kBrickNodes} * kBrickNodes * kBrickNodes;

    struct Cell;  // the eight corners around a point
    bool locate(const Vec3& p, Cell& cell) const noexcept;
    double boxDistance(const Vec3& p) const noexcept;
    double rounding(const Cell& cell, double weights) const noexcept;
    double farthestSurface(const Cell& cell) const noexcept;
    void sampleCoarse(const DistanceSource& source);
    bool sampleBricks(const DistanceSource& source, double band);  // false: more than 2 GiB
    std::size_t coarseNode(int x, int y, int z) const noexcept;
    std::size_t coarseCell(int x, int y, int z) const noexcept;

    Bounds surface_bounds_;
    Vec3 origin_ = Vec3::Zero();         // of the coarse grid
    std::array<int, 3> coarse_cells_{};  // per axis
    double cell_ = 0.0;                  // fine cell [m]
    double brick_edge_ = 0.0;            // coarse cell [m]
    double inverse_brick_edge_ = 0.0;
    double sheet_offset_ = 0.0;
    double arithmetic_ = 0.0;  // what rounding in double precision may add up to [m]
    bool bound_proven_ = true;
    std::vector<float> coarse_;                // nodes
    std::vector<std::int32_t> brick_of_cell_;  // -1: none
    std::vector<float> bricks_;                // brickCount × 9³, x fastest
};

}  // namespace passung::model
