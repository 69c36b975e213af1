#include "core/field/mesh_block_signs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace passung::field {

namespace {

/// In a direction of no meaning: edges of parts often lie on nodes, and what crosses at an edge would have to be told
/// by rounding.
constexpr double kShift = 0.1 * kLineShift;
const Vec3 kShiftDirection(0.72, 0.41, 0.56);  // of about unit length

using Triangles = std::vector<const FlatTriangle*>;

/// On which side of the line through p and q the point r lies, all projected along one axis. The corners come in one
/// order for both triangles at an edge, so that they agree about every point, whatever the rounding.
bool isLeft(const Vec3& p, const Vec3& q, double r1, double r2, int axis1, int axis2) {
    const bool swapped = std::pair(p[axis1], p[axis2]) > std::pair(q[axis1], q[axis2]);
    const Vec3 &a = swapped ? q : p, &b = swapped ? p : q;
    const double twice_area = (b[axis1] - a[axis1]) * (r2 - a[axis2]) - (b[axis2] - a[axis2]) * (r1 - a[axis1]);
    return (twice_area > 0.0) != swapped;
}

/// A triangle with its box, in cells from the first line.
struct Boxed {
    const FlatTriangle* triangle;
    Vec3 low, high;
};

class Signs {
public:
    Signs(const geometry::TriangleTree& tree, const Vec3& low, double cell, SurfaceBlock& block)
        : tree_(tree), low_(low), lines_(low + kShift * cell * kShiftDirection), cell_(cell), block_(block) {}

    void giveSigns(const Triangles& all);

private:
    static constexpr int kCells = SurfaceBlock::kCells, kNodes = SurfaceBlock::kNodes;
    static constexpr std::array<int, 3> kStride{1, kNodes, kNodes* kNodes};

    Vec3 at(double x, double y, double z) const { return low_ + cell_ * Vec3(x, y, z); }
    void countAlong(const std::vector<Boxed>& triangles, int axis, int rows1, int rows2);
    bool consistent() const;

    const geometry::TriangleTree& tree_;
    const Vec3 low_, lines_;
    const double cell_;
    SurfaceBlock& block_;
    std::array<int, SurfaceBlock::kAllNodes> winding_{};
};

/// Winding numbers of the nodes of `rows1` × `rows2` lines along an axis, from that of each line's first node: less by
/// 1 behind a triangle that is left through its front, more by 1 behind one that is entered.
void Signs::countAlong(const std::vector<Boxed>& triangles, int axis, int rows1, int rows2) {
    const int axis1 = (axis + 1) % 3, axis2 = (axis + 2) % 3;
    const auto node = [&](int i1, int i2, int j) {
        return static_cast<std::size_t>(j * kStride[static_cast<std::size_t>(axis)] +
                                        i1 * kStride[static_cast<std::size_t>(axis1)] +
                                        i2 * kStride[static_cast<std::size_t>(axis2)]);
    };
    for (int i2 = 0; i2 < rows2; ++i2)
        for (int i1 = 0; i1 < rows1; ++i1)
            for (int j = 1; j < kNodes; ++j) winding_[node(i1, i2, j)] = winding_[node(i1, i2, 0)];
    for (const auto& [triangle, low, high] : triangles) {
        const FlatTriangle& t = *triangle;
        const auto& [a, b, c] = t.corner;
        const auto begin = [&low = low](int k) {
            return static_cast<int>(std::clamp(std::floor(low[k]), 0.0, 1.0 * kNodes));
        };
        const auto end = [&high = high](int k, int rows) {
            return static_cast<int>(std::clamp(std::ceil(high[k]) + 1.0, 0.0, static_cast<double>(rows)));
        };
        for (int i2 = begin(axis2); i2 < end(axis2, rows2); ++i2)
            for (int i1 = begin(axis1); i1 < end(axis1, rows1); ++i1) {
                const double r1 = lines_[axis1] + cell_ * i1, r2 = lines_[axis2] + cell_ * i2;
                const bool left = isLeft(a, b, r1, r2, axis1, axis2);
                if (isLeft(b, c, r1, r2, axis1, axis2) != left || isLeft(c, a, r1, r2, axis1, axis2) != left) continue;
                const double rise = t.normal[axis1] * (r1 - a[axis1]) + t.normal[axis2] * (r2 - a[axis2]);
                const double crossing = (a[axis] - rise / t.normal[axis] - lines_[axis]) / cell_;
                // Of a triangle along the line the crossing is lost in rounding, or no number.
                const double place = crossing > low[axis] ? std::min(crossing, high[axis]) : low[axis];
                if (!(place > 0.0)) continue;
                for (int j = kCells; j > place; --j) winding_[node(i1, i2, j)] += left ? -1 : 1;
            }
    }
}

void Signs::giveSigns(const Triangles& all) {
    std::vector<Boxed> triangles;
    for (const FlatTriangle* const t : all) {
        const auto& [a, b, c] = t->corner;
        const Vec3 low = (a.cwiseMin(b).cwiseMin(c) - lines_) / cell_;
        const Vec3 high = (a.cwiseMax(b).cwiseMax(c) - lines_) / cell_;
        if (low.maxCoeff() <= kCells && high.minCoeff() >= 0.0) triangles.push_back({t, low, high});
    }
    winding_[0] = static_cast<int>(std::lround(tree_.windingNumber(lines_)));
    countAlong(triangles, 2, 1, 1);
    countAlong(triangles, 1, kNodes, 1);
    countAlong(triangles, 0, kNodes, kNodes);
    const bool counted = consistent();
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i) {
        // The lines pass the nodes by.
        if (counted && !(block_.node[i] > 0.0 && block_.node[i] < 2.0 * kShift * cell_)) continue;
        const int n = static_cast<int>(i);
        winding_[i] = tree_.inside(at(n % kNodes, n / kNodes % kNodes, n / (kNodes * kNodes))) ? 1 : 0;
    }
    if (!counted) block_.slack.fill(1.0);
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i)
        if (winding_[i] > 0) block_.node[i] = -block_.node[i];
}

/// Neighbours on different sides of the surface are no farther from it, together, than from each other.
bool Signs::consistent() const {
    const double most = cell_ * (1.0 + 4.0 * kShift);
    for (std::size_t i = 0; i < SurfaceBlock::kAllNodes; ++i)
        for (const int stride : kStride) {
            if (static_cast<int>(i) / stride % kNodes == kCells) continue;
            const std::size_t next = i + static_cast<std::size_t>(stride);
            if ((winding_[i] > 0) != (winding_[next] > 0) && block_.node[i] + block_.node[next] > most) return false;
        }
    return true;
}

}  // namespace

void giveSigns(const geometry::TriangleTree& tree, const Triangles& triangles, const Vec3& low, double cell,
               SurfaceBlock& block) {
    Signs(tree, low, cell, block).giveSigns(triangles);
}

}  // namespace passung::field
