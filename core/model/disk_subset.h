#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.h"

namespace passung::model {

/// Points in cubic buckets, for neighbours within one bucket edge. Memory is one integer per bucket of the box.
class PointBuckets {
public:
    /// Buckets of at least `edge` over the box of `positions`; larger ones where that would be more than kMost per
    /// axis.
    PointBuckets(std::span<const Vec3> positions, double edge);

    /// `index`: what visitAround gives back for this point; each at most once.
    void insert(const Vec3& p, std::uint32_t index);

    /// Calls `visit(index)` for every inserted point in the 27 buckets around `p`.
    template <class Visit>
    void visitAround(const Vec3& p, const Visit& visit) const {
        const std::array<int, 3> c = cellOf(p);
        for (int z = std::max(0, c[2] - 1); z <= std::min(count_[2] - 1, c[2] + 1); ++z) {
            for (int y = std::max(0, c[1] - 1); y <= std::min(count_[1] - 1, c[1] + 1); ++y) {
                for (int x = std::max(0, c[0] - 1); x <= std::min(count_[0] - 1, c[0] + 1); ++x) {
                    for (std::int32_t i = first_[indexOf(x, y, z)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
                        visit(static_cast<std::uint32_t>(i));
                    }
                }
            }
        }
    }

private:
    static constexpr int kMost = 256;
    std::array<int, 3> cellOf(const Vec3& p) const;
    std::size_t indexOf(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(x);
    }

    Vec3 low_;
    double inverse_edge_;
    std::array<int, 3> count_{};
    std::vector<std::int32_t> first_, next_;  // linked lists: bucket → point → point, -1 ends
};

/// Indices of a Poisson-disk subset of the points in `order`, which are tried in that order: no two of them that face
/// within 60° of each other are closer than `radius`, and every point tried is one of them or has such a one closer
/// than `radius`. A point without a normal (zero) faces nobody and is always taken.
std::vector<std::uint32_t> diskSubset(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                      std::span<const std::uint32_t> order);

inline constexpr std::uint32_t kNoPoint = ~0u;

/// For each point the place in `chosen` of the nearest chosen point closer than `radius` that faces within 60° of it,
/// or kNoPoint (for the result of diskSubset with the same radius: only points without a normal).
std::vector<std::uint32_t> assignNearest(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                         std::span<const std::uint32_t> chosen);

/// True if two surface normals are within 60°.
inline bool facesAlike(const Vec3& a, const Vec3& b) { return a.dot(b) > 0.5; }

}  // namespace passung::model
