#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/assert.h"
#include "core/geometry/parallel.h"
#include "core/geometry/triangle_tree.h"

/// How a TriangleTree is made; its queries are in triangle_tree.cpp.
namespace passung::geometry {

namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr int kBins = 16;
constexpr double kFarRadii = 2.0;  // a cluster is far at this many of its radii (Barill's β)
constexpr double kNeedle = 1e-4;   // height over longest edge, below which a triangle is treated with care

/// A triangle while the tree is built.
struct TreeTriangle {
    Vec3 low, high, centre;
    std::uint32_t index;
};

double halfArea(const Vec3& low, const Vec3& high) {
    const Vec3 s = high - low;
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

struct Bin {
    Bounds box;
    std::uint32_t count = 0;
    double cost() const { return count > 0 ? halfArea(box.low, box.high) * count : 0.0; }
    void add(const Bin& other) {
        box.low = box.low.cwiseMin(other.box.low);
        box.high = box.high.cwiseMax(other.box.high);
        count += other.count;
    }
};

int binOf(double centre, double low, double extent) {
    return std::clamp(static_cast<int>(kBins * ((centre - low) / extent)), 0, kBins - 1);
}

using Bins = std::array<Bin, kBins>;

/// Where triangles are parted: bins of an axis, so many of them on the left.
struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    int axis = -1, bins = 0;
};

/// Takes the cheapest of an axis' kBins - 1 splits by the surface area heuristic, if it is cheaper than `best`.
void improve(Cut& best, const Bins& bins, int axis, std::uint32_t count) {
    std::array<double, kBins> right_cost{};
    Bin right;
    for (std::size_t b = kBins - 1; b > 0; --b) {
        right.add(bins[b]);
        right_cost[b] = right.cost();
    }
    Bin left;
    for (std::size_t b = 1; b < kBins; ++b) {
        left.add(bins[b - 1]);
        const double cost = left.cost() + right_cost[b];
        if (left.count > 0 && left.count < count && cost < best.cost) best = {cost, axis, static_cast<int>(b)};
    }
}

/// No axis of it, if all centres are at one place.
Cut cheapestCut(const TreeTriangle* items, std::uint32_t count, const Bounds& centres) {
    const Vec3 extent = centres.size();
    std::array<Bins, 3> bins;
    for (std::uint32_t i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            if (!(extent[axis] > 0.0)) continue;
            const int at = binOf(items[i].centre[axis], centres.low[axis], extent[axis]);
            Bin& bin = bins[static_cast<std::size_t>(axis)][static_cast<std::size_t>(at)];
            bin.box.extend(items[i].low);
            bin.box.extend(items[i].high);
            ++bin.count;
        }
    Cut best;
    for (int axis = 0; axis < 3; ++axis)
        if (extent[axis] > 0.0) improve(best, bins[static_cast<std::size_t>(axis)], axis, count);
    return best;
}

/// Sorts `items` into two groups, in the middle if `by_halves`, else where it is cheapest; how many are in the first.
/// Never 0, never all. `centres`: the box of theirs.
std::uint32_t split(TreeTriangle* items, std::uint32_t count, const Bounds& centres, bool by_halves) {
    const Cut cut = by_halves ? Cut{} : cheapestCut(items, count, centres);
    if (cut.axis >= 0) {
        const double low = centres.low[cut.axis], extent = centres.size()[cut.axis];
        const TreeTriangle* middle = std::stable_partition(items, items + count, [&](const TreeTriangle& item) {
            return binOf(item.centre[cut.axis], low, extent) < cut.bins;
        });
        return static_cast<std::uint32_t>(middle - items);
    }
    int axis = 0;
    centres.size().maxCoeff(&axis);
    std::sort(items, items + count, [axis](const TreeTriangle& a, const TreeTriangle& b) {
        return std::pair(a.centre[axis], a.index) < std::pair(b.centre[axis], b.index);
    });
    return count / 2;
}

bool isNeedle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).norm() > kNeedle * longest2);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
    PASSUNG_ASSERT(!mesh.triangles.empty());
    const std::size_t n = mesh.triangles.size();
    std::vector<TreeTriangle> items(n);
    for (std::size_t i = 0; i < n; ++i) {
        Bounds box;
        for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.vertices[v]);
        items[i] = {box.low, box.high, 0.5 * (box.low + box.high), static_cast<std::uint32_t>(i)};
    }

    struct Task {
        std::uint32_t node, first, count;
        int depth;
    };
    std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(n), 0}};
    nodes_.resize(1);
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        Bounds box, centres;
        for (std::uint32_t i = task.first; i < task.first + task.count; ++i) {
            box.extend(items[i].low);
            box.extend(items[i].high);
            centres.extend(items[i].centre);
        }
        nodes_[task.node] = {box.low, box.high, task.first, task.count};
        if (task.count <= kLeafTriangles) continue;
        const std::uint32_t left = split(items.data() + task.first, task.count, centres, task.depth >= kSahDepth);
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        nodes_[task.node].first = child;
        nodes_[task.node].count = 0;
        tasks.push_back({child + 1, task.first + left, task.count - left, task.depth + 1});
        tasks.push_back({child, task.first, left, task.depth + 1});
    }

    corners_.reserve(n);
    original_.reserve(n);
    for (const TreeTriangle& item : items) {
        const Triangle& t = mesh.triangles[item.index];
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        corners_.push_back({a, b, c, isNeedle(a, b, c)});
        original_.push_back(item.index);
    }

    // The triangles below a node are contiguous: from the first of its leftmost leaf to the last of its rightmost one.
    // Children come after their parent, so the ranges are known when going backwards.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(nodes_.size());
    for (std::size_t k = nodes_.size(); k-- > 0;) {
        const Node& node = nodes_[k];
        ranges[k] = node.count > 0 ? std::pair(node.first, node.first + node.count)
                                   : std::pair(ranges[node.first].first, ranges[node.first + 1].second);
    }
    clusters_.resize(nodes_.size());
    constexpr std::size_t kAtOnce = 4096;
    parallelFor((nodes_.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t i) {
        const std::size_t end = std::min(nodes_.size(), (i + 1) * kAtOnce);
        for (std::size_t k = i * kAtOnce; k < end; ++k)
            clusters_[k] = summarise(ranges[k].first, ranges[k].second - ranges[k].first);
    });
}

TriangleTree::Cluster TriangleTree::summarise(std::uint32_t first, std::uint32_t count) const {
    Vec3 dipole = Vec3::Zero(), moment = Vec3::Zero(), mean = Vec3::Zero();
    double area = 0.0;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const auto& [a, b, c, needle] = corners_[i];
        const Vec3 normal = 0.5 * (b - a).cross(c - a);
        const Vec3 centroid = (a + b + c) / 3.0;
        dipole += normal;
        moment += normal.norm() * centroid;
        mean += centroid / count;
        area += normal.norm();
    }
    const Vec3 centre = area > 0.0 ? Vec3(moment / area) : mean;
    double radius2 = 0.0;
    for (std::uint32_t i = first; i < first + count; ++i)
        for (const Vec3& corner : {corners_[i].a, corners_[i].b, corners_[i].c})
            radius2 = std::max(radius2, (corner - centre).squaredNorm());
    return {centre, dipole, kFarRadii * kFarRadii * radius2};
}

}  // namespace passung::geometry
