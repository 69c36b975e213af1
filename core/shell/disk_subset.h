#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"
#include "core/geometry/mesh.h"

namespace passung::shell {

/// Points of a surface in cubic buckets, for neighbours near by. Buckets come in blocks, and only blocks that hold a
/// point take memory: 4 bytes a bucket, besides 4 bytes for every block of the box.
class PointBuckets {
public:
    /// Buckets of at least `edge` over the box of `positions`; larger ones where a long thin part would need more than
    /// kMostBlocks blocks.
    PointBuckets(std::span<const Vec3> positions, double edge);
    PointBuckets(const geometry::Bounds& bounds, double edge);

    double edge() const { return edge_; }

    /// `index`: what visitWithin gives back for this point; each at most once.
    void insert(const Vec3& p, std::uint32_t index);

    /// Calls `squared = visit(index, squared)` for every inserted point in a bucket that comes nearer to `p` than the
    /// root of `squared`, which starts as the square of `radius`; the bucket of `p` is first. A visitor that returns
    /// less narrows the search, one that returns a negative number ends it.
    template <class Visit>
    void visitWithin(const Vec3& p, double radius, const Visit& visit) const {
        const std::array<int, 3> c = cellOf(p);
        double squared = visitCell(c, radius * radius, visit);
        const Vec3 in_cell = (p - low_) * inverse_edge_ - Vec3(c[0], c[1], c[2]);
        const auto gap = [&](int axis, int step) {  // squared distance of the slab `step` cells away
            const double cells = step > 0 ? step - in_cell[axis] : step < 0 ? in_cell[axis] - (step + 1) : 0.0;
            return cells > 0.0 ? cells * cells * edge_ * edge_ : 0.0;
        };
        // 0, -1, 1, -2, 2, ...: what is near narrows the search before what is far is looked at.
        const int steps = 2 * static_cast<int>(std::ceil(radius * inverse_edge_)) + 1;
        const auto step = [](int i) { return (i & 1) ? -(i / 2 + 1) : i / 2; };
        for (int iz = 0; iz < steps; ++iz) {
            const int z = step(iz);
            const double dz = gap(2, z);
            if (dz >= squared || outside(c[2] + z, 2)) continue;
            for (int iy = 0; iy < steps; ++iy) {
                const int y = step(iy);
                const double dy = dz + gap(1, y);
                if (dy >= squared || outside(c[1] + y, 1)) continue;
                for (int ix = iy == 0 && iz == 0 ? 1 : 0; ix < steps; ++ix) {
                    const int x = step(ix);
                    if (dy + gap(0, x) >= squared || outside(c[0] + x, 0)) continue;
                    squared = visitCell({c[0] + x, c[1] + y, c[2] + z}, squared, visit);
                }
            }
        }
    }

private:
    static constexpr int kShift = 3, kMask = (1 << kShift) - 1;  // a block is 8³ buckets
    static constexpr std::size_t kBlockCells = 512;
    static constexpr double kMostBlocks = 1 << 22;

    std::array<int, 3> cellOf(const Vec3& p) const;
    bool outside(int cell, std::size_t axis) const { return cell < 0 || cell >= count_[axis]; }
    std::size_t blockOf(const std::array<int, 3>& c) const {
        return (static_cast<std::size_t>(c[2] >> kShift) * blocks_[1] + static_cast<std::size_t>(c[1] >> kShift)) *
                   blocks_[0] +
               static_cast<std::size_t>(c[0] >> kShift);
    }
    static std::size_t inBlock(const std::array<int, 3>& c) {
        return static_cast<std::size_t>((((c[2] & kMask) << kShift | (c[1] & kMask)) << kShift) | (c[0] & kMask));
    }
    template <class Visit>
    double visitCell(const std::array<int, 3>& c, double squared, const Visit& visit) const {
        const std::int32_t block = block_[blockOf(c)];
        if (block < 0) return squared;
        for (std::int32_t i = first_[static_cast<std::size_t>(block) * kBlockCells + inBlock(c)]; i >= 0;
             i = next_[static_cast<std::size_t>(i)])
            squared = visit(static_cast<std::uint32_t>(i), squared);
        return squared;
    }

    Vec3 low_;
    double edge_, inverse_edge_;
    std::array<int, 3> count_{};              // of buckets
    std::array<std::size_t, 3> blocks_{};     // of blocks
    std::vector<std::int32_t> block_;         // of the box; -1: nothing in it
    std::vector<std::int32_t> first_, next_;  // linked lists: bucket → point → point, -1 ends
};

/// True if two surface normals are within 60°.
inline bool facesAlike(const Vec3& a, const Vec3& b) { return a.dot(b) > 0.5; }

/// Indices of a Poisson-disk subset of the points in `order`, which are tried in that order: no two of them that face
/// within 60° of each other are closer than `radius`, and every point tried is one of them or has such a one closer
/// than `radius`. A point without a normal (zero) faces nobody and is always taken.
/// `position(i)` and `normal(i)` give point i; `bounds` holds all points tried.
template <class Position, class Normal>
std::vector<std::uint32_t> diskSubset(const geometry::Bounds& bounds, const Position& position, const Normal& normal,
                                      double radius, std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> chosen;
    std::vector<Vec3> at, facing;
    PointBuckets buckets(bounds, radius);
    for (const std::uint32_t i : order) {
        const Vec3 p = position(i), n = normal(i);
        bool free = true;
        buckets.visitWithin(p, radius, [&](std::uint32_t k, double squared) {
            if (!((p - at[k]).squaredNorm() < squared && facesAlike(n, facing[k]))) return squared;
            free = false;
            return -1.0;
        });
        if (!free) continue;
        buckets.insert(p, static_cast<std::uint32_t>(chosen.size()));
        chosen.push_back(i);
        at.push_back(p);
        facing.push_back(n);
    }
    return chosen;
}
std::vector<std::uint32_t> diskSubset(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                      std::span<const std::uint32_t> order);

inline constexpr std::uint32_t kNoPoint = ~0u;

/// Chosen points, to be asked for the nearest one.
class NearestAlike {
public:
    NearestAlike(const geometry::Bounds& bounds, std::span<const Vec3> positions, std::span<const Vec3> normals,
                 double edge);

    /// The nearest point closer than `radius` that faces within 60° of `normal`, or kNoPoint; of two equally near ones
    /// the first. `hint`: a point that may be near, which saves time.
    std::uint32_t at(const Vec3& p, const Vec3& normal, double radius, std::uint32_t hint = kNoPoint) const;

private:
    std::span<const Vec3> positions_, normals_;
    PointBuckets buckets_;
};

/// For each point the place in `chosen` of the nearest chosen point closer than `radius` that faces within 60° of it,
/// or kNoPoint (for the result of diskSubset with the same radius: only points without a normal).
std::vector<std::uint32_t> assignNearest(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                         std::span<const std::uint32_t> chosen);

}  // namespace passung::shell
