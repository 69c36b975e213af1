#include "core/surface/approach.h"

#include <algorithm>
#include <cmath>

namespace passung::surface {

namespace {

constexpr std::size_t kSide = NormalClass::kSide;
constexpr std::size_t kCorners = 6 * (kSide + 1) * (kSide + 1);  // those on the cube's edges several times

/// Side 2 axis + (0: positive, 1: negative); u and v run along the two axes after it.
Vec3 onSide(std::size_t side, double u, double v) {
    const std::size_t axis = side / 2;
    Vec3 p;
    p[static_cast<Eigen::Index>(axis)] = side % 2 == 0 ? 1.0 : -1.0;
    p[static_cast<Eigen::Index>((axis + 1) % 3)] = u;
    p[static_cast<Eigen::Index>((axis + 2) % 3)] = v;
    return p;
}

struct NormalCells {
    std::array<double, kCorners> x, y, z;                                 // unit vectors
    std::array<std::array<std::size_t, 4>, NormalClass::kCount> corners;  // of each cell
    PerClass factor;                                                      // 1 / min c_i · e

    NormalCells() {
        for (std::size_t side = 0; side < 6; ++side)
            for (std::size_t i = 0; i <= kSide; ++i)
                for (std::size_t k = 0; k <= kSide; ++k) {
                    const Vec3 c = onSide(side, NormalClass::kBorders[i], NormalClass::kBorders[k]).normalized();
                    const std::size_t at = cornerAt(side, i, k);
                    x[at] = c.x();
                    y[at] = c.y();
                    z[at] = c.z();
                }
        for (std::size_t cell = 0; cell < NormalClass::kCount; ++cell) {
            const std::size_t side = cell / (kSide * kSide), i = cell / kSide % kSide, k = cell % kSide;
            corners[cell] = {cornerAt(side, i, k), cornerAt(side, i + 1, k), cornerAt(side, i, k + 1),
                             cornerAt(side, i + 1, k + 1)};
            Vec3 middle = Vec3::Zero();
            for (const std::size_t c : corners[cell]) middle += Vec3(x[c], y[c], z[c]);
            middle.normalize();
            double least = 1.0;
            for (const std::size_t c : corners[cell]) least = std::min(least, middle.dot(Vec3(x[c], y[c], z[c])));
            factor[cell] = (1.0 + 1e-12) / least;
        }
    }

    static std::size_t cornerAt(std::size_t side, std::size_t i, std::size_t k) {
        return (side * (kSide + 1) + i) * (kSide + 1) + k;
    }
};

const NormalCells kCells;

}  // namespace

void measureApproach(const geometry::Bounds& box, const Mat3& turn, const Vec3& move, PerClass& nearer) noexcept {
    const Vec3 middle = turn * (0.5 * (box.low + box.high)) + move;
    const Vec3 half = 0.5 * box.size();
    const Vec3 p = half.x() * turn.col(0), q = half.y() * turn.col(1), r = half.z() * turn.col(2);
    std::array<double, kCorners> reach;  // against the corners of all cells
    for (std::size_t c = 0; c < kCorners; ++c) {
        const double x = kCells.x[c], y = kCells.y[c], z = kCells.z[c];
        const double along = x * middle.x() + y * middle.y() + z * middle.z();
        const double spread = std::abs(x * p.x() + y * p.y() + z * p.z()) +
                              std::abs(x * q.x() + y * q.y() + z * q.z()) + std::abs(x * r.x() + y * r.y() + z * r.z());
        reach[c] = std::max(0.0, spread - along);
    }
    for (std::size_t cell = 0; cell < NormalClass::kCount; ++cell) {
        const auto& of = kCells.corners[cell];
        nearer[cell] =
            kCells.factor[cell] * std::max(std::max(reach[of[0]], reach[of[1]]), std::max(reach[of[2]], reach[of[3]]));
    }
}

}  // namespace passung::surface
