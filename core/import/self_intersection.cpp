#include "core/import/self_intersection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/hash_mix.h"

namespace passung::importer {

namespace {

/// What rounding may make of a volume that is zero, as a share of the product of the lengths that span it.
constexpr double kTouching = 1e-9;
/// Of one triangle: a pile of thousands upon one place is found by fewer.
constexpr std::size_t kMostNeighbours = 256;

struct CyclicCorners {
    std::array<Vec3, 3> at;
    const Vec3& operator[](std::size_t k) const { return at[k % 3]; }
};

/// Six times the volume of a tetrahedron, 0 if it is flat up to rounding.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double value = u.dot(v.cross(w));
    return std::abs(value) > kTouching * u.norm() * v.norm() * w.norm() ? value : 0.0;
}

/// Strictly: through the triangle's inside, with the ends on two sides of its plane.
bool passesThrough(const Vec3& from, const Vec3& to, const CyclicCorners& t) {
    const double from_side = volume(t[0], t[1], t[2], from), to_side = volume(t[0], t[1], t[2], to);
    if (!(from_side * to_side < 0.0)) return false;
    const double first = volume(from, to, t[0], t[1]), second = volume(from, to, t[1], t[2]),
                 third = volume(from, to, t[2], t[0]);
    return (first > 0.0 && second > 0.0 && third > 0.0) || (first < 0.0 && second < 0.0 && third < 0.0);
}

/// A triangle of the mesh, its corners as places and as names.
struct NamedTriangle {
    CyclicCorners at;
    const geometry::Triangle& name;
};

/// True if one of the edges of `a` passes through `b`. An edge that ends at a corner of `b` lies on one side.
bool passesThrough(const NamedTriangle& a, const NamedTriangle& b) {
    const auto shared = [&](std::size_t k) {
        return std::find(b.name.begin(), b.name.end(), a.name[k]) != b.name.end();
    };
    const std::array<bool, 3> corner{shared(0), shared(1), shared(2)};
    for (std::size_t k = 0; k < 3; ++k)
        if (!corner[k] && !corner[(k + 1) % 3] && passesThrough(a.at[k], a.at[k + 1], b.at)) return true;
    return false;
}

bool cross(const NamedTriangle& a, const NamedTriangle& b) { return passesThrough(a, b) || passesThrough(b, a); }

/// Boxes by the cells of grids that they lie in, so that those which meet are found. A box lies in the finest grid
/// whose cells are twice as long, hence in at most eight of its cells. Cells of one hash share a list.
class BoxGrids {
public:
    BoxGrids(const std::vector<geometry::Bounds>& boxes, const geometry::Bounds& all)
        : boxes_(boxes), origin_(all.low), levels_(boxes.size()) {
        finest_ = std::max(all.size().maxCoeff() / (1 << (kLevels - 3)), 1e-300);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const double length = boxes[i].size().maxCoeff();
            for (double edge = finest_; edge < 2.0 * length && levels_[i] < kLevels - 1; edge *= 2.0) ++levels_[i];
            used_[levels_[i]] = true;
        }
        begin_.assign(std::bit_ceil(2 * boxes.size()) + 1, 0);
        forEachEntry([&](std::size_t list, std::uint32_t) { ++begin_[list + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        members_.resize(begin_.back());
        std::vector<std::size_t> next = begin_;
        forEachEntry([&](std::size_t list, std::uint32_t i) { members_[next[list]++] = i; });
    }

    /// Calls `visit` with each box that meets box `i` and is larger, or as large and of a higher number, the first
    /// `most` of them.
    template <class Visit>
    void forEachMeeting(std::uint32_t i, std::size_t most, const Visit& visit) const {
        std::size_t count = 0;
        for (std::size_t level = levels_[i]; level < kLevels; ++level) {
            if (!used_[level]) continue;
            forEachCell(boxes_[i], level, [&](const Cell& cell) {
                const std::size_t list = listOf(cell, level);
                for (std::size_t at = begin_[list]; at < begin_[list + 1] && count < most; ++at) {
                    const std::uint32_t k = members_[at];
                    if (levels_[k] != level || (level == levels_[i] && k <= i) || !meet(boxes_[i], boxes_[k])) continue;
                    // Of the cells that both lie in it counts in one.
                    if (cellOf(boxes_[i].low.cwiseMax(boxes_[k].low), level) != cell) continue;
                    ++count;
                    visit(k);
                }
            });
        }
    }

private:
    static constexpr std::size_t kLevels = 24;
    using Cell = std::array<std::int64_t, 3>;

    static bool meet(const geometry::Bounds& a, const geometry::Bounds& b) {
        return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
    }

    Cell cellOf(const Vec3& p, std::size_t level) const {
        const Vec3 at = (p - origin_) / std::ldexp(finest_, static_cast<int>(level));
        return {static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
                static_cast<std::int64_t>(at.z())};
    }

    std::size_t listOf(const Cell& cell, std::size_t level) const {
        std::uint64_t h = level;
        for (const std::int64_t c : cell) h = hashMix(h, static_cast<std::uint64_t>(c));
        return static_cast<std::size_t>(h) & (begin_.size() - 2);
    }

    template <class Visit>
    void forEachCell(const geometry::Bounds& box, std::size_t level, const Visit& visit) const {
        const Cell low = cellOf(box.low, level), high = cellOf(box.high, level);
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
            for (std::int64_t y = low[1]; y <= high[1]; ++y)
                for (std::int64_t z = low[2]; z <= high[2]; ++z) visit(Cell{x, y, z});
    }

    /// Each list that a box belongs to, once: cells of it may share one.
    template <class Visit>
    void forEachEntry(const Visit& visit) const {
        std::vector<std::size_t> lists;
        for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
            lists.clear();
            forEachCell(boxes_[i], levels_[i], [&](const Cell& cell) {
                const std::size_t list = listOf(cell, levels_[i]);
                if (std::find(lists.begin(), lists.end(), list) != lists.end()) return;
                lists.push_back(list);
                visit(list, i);
            });
        }
    }

    const std::vector<geometry::Bounds>& boxes_;
    Vec3 origin_;
    double finest_ = 0.0;               // edge of the finest cells
    std::vector<std::uint8_t> levels_;  // of the boxes: cells of finest_ 2^level
    std::array<bool, kLevels> used_{};
    std::vector<std::size_t> begin_;      // of each list
    std::vector<std::uint32_t> members_;  // of all lists
};

}  // namespace

Crossings crossingsOf(const geometry::TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return {};
    const auto triangleAt = [&](std::size_t i) {
        const geometry::Triangle& t = mesh.triangles[i];
        return NamedTriangle{{{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}}, t};
    };
    std::vector<geometry::Bounds> boxes(mesh.triangles.size());
    geometry::Bounds all;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (const std::uint32_t v : mesh.triangles[i]) boxes[i].extend(mesh.vertices[v]);
        all.extend(boxes[i].low);
        all.extend(boxes[i].high);
    }
    const BoxGrids grids(boxes, all);
    Crossings found;
    std::vector<char> crossing(mesh.triangles.size(), 0);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const NamedTriangle triangle = triangleAt(i);
        grids.forEachMeeting(i, kMostNeighbours, [&](std::uint32_t k) {
            if (!cross(triangle, triangleAt(k))) return;
            crossing[i] = crossing[k] = 1;
            found.pairs += 2;
        });
    }
    found.triangles = static_cast<std::size_t>(std::count(crossing.begin(), crossing.end(), 1));
    return found;
}

}  // namespace passung::importer
