#include "core/shell/sphere_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/single_precision.h"
#include "core/geometry/parallel.h"
#include "core/shell/enclosing_ball.h"

namespace passung::shell {

namespace {

// Two unit vectors that lie in a box with sides up to 1 are no farther apart than √3: the angle is at most 120°.
constexpr float kMostFacing = 1.0f;
constexpr std::size_t kNodesAtOnce = 64;  // nodes that one thread summarises at a time

/// A point while clusters are formed.
struct ClusterPoint {
    std::array<float, 3> position, normal;
    std::uint32_t index;
    bool face;  // else on an edge or a corner
};

struct PointRange {
    std::uint32_t begin, end;
    std::uint32_t count() const { return end - begin; }
};

/// Least and largest of three coordinates.
struct Extent {
    std::array<float, 3> low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
    void extend(const std::array<float, 3>& v) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], v[k]);
            high[k] = std::max(high[k], v[k]);
        }
    }
    std::size_t longest() const {
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
        return axis;
    }
    float side(std::size_t axis) const { return high[axis] - low[axis]; }
};

/// Halves `range` where its faces turn too far; else returns its beginning.
std::uint32_t partFacing(std::vector<ClusterPoint>& items, const PointRange& range) {
    const auto begin = items.begin() + range.begin, end = items.begin() + range.end;
    Extent facing;
    for (auto i = begin; i != end; ++i)
        if (i->face) facing.extend(i->normal);
    const std::size_t axis = facing.longest();
    if (!(facing.side(axis) > kMostFacing)) return range.begin;
    const float middle = 0.5f * (facing.low[axis] + facing.high[axis]);
    const auto half = std::partition(begin, end, [&](const ClusterPoint& item) { return item.normal[axis] < middle; });
    return static_cast<std::uint32_t>(half - items.begin());
}

/// Halves `range` across its longest side if it is more than `whole`; else returns its beginning.
std::uint32_t halve(std::vector<ClusterPoint>& items, const PointRange& range, std::uint32_t whole) {
    if (range.count() <= whole) return range.begin;
    const auto begin = items.begin() + range.begin, end = items.begin() + range.end;
    Extent place;
    for (auto i = begin; i != end; ++i) place.extend(i->position);
    const std::size_t axis = place.longest();
    // Whole leaves on one side, so that leaves are full.
    const std::uint32_t leaves = (range.count() + whole - 1) / whole;
    const auto half = begin + static_cast<std::ptrdiff_t>(leaves / 2 * whole);
    std::nth_element(begin, half, end, [axis](const ClusterPoint& a, const ClusterPoint& b) {
        return a.position[axis] < b.position[axis] || (a.position[axis] == b.position[axis] && a.index < b.index);
    });
    return static_cast<std::uint32_t>(half - items.begin());
}

std::uint32_t halveToLeaves(std::vector<ClusterPoint>& items, const PointRange& range) {
    return halve(items, range, SphereTree::kLeafPoints);
}

/// Neighbours of a leaf next to each other, down to its groups.
void arrangeGroups(std::vector<ClusterPoint>& items, const PointRange& range) {
    const std::uint32_t middle = halve(items, range, SphereTree::kGroupPoints);
    if (middle == range.begin) return;
    arrangeGroups(items, {range.begin, middle});
    arrangeGroups(items, {middle, range.end});
}

/// Splits ranges by `cut`, the largest first, until there are kChildren or none can be split.
template <class Cut>
void splitAll(std::vector<ClusterPoint>& items, std::vector<PointRange>& ranges, const Cut& cut) {
    std::vector<bool> whole(ranges.size(), false);
    while (ranges.size() < SphereTree::kChildren) {
        std::size_t largest = ranges.size();
        for (std::size_t i = 0; i < ranges.size(); ++i)
            if (!whole[i] && (largest == ranges.size() || ranges[i].count() > ranges[largest].count())) largest = i;
        if (largest == ranges.size()) return;
        const std::uint32_t middle = cut(items, ranges[largest]);
        if (middle == ranges[largest].begin) {
            whole[largest] = true;
            continue;
        }
        const PointRange right{middle, ranges[largest].end};
        ranges[largest].end = middle;
        const auto next = static_cast<std::ptrdiff_t>(largest + 1);
        ranges.insert(ranges.begin() + next, right);
        whole.insert(whole.begin() + next, false);
    }
}

/// Up to kChildren parts of `range`; one part if it is a leaf. A direction's box is halved at most once along each
/// axis, so that eight parts are enough to part what faces apart.
std::vector<PointRange> part(std::vector<ClusterPoint>& items, const PointRange& range) {
    std::vector<PointRange> ranges{range};
    splitAll(items, ranges, partFacing);
    splitAll(items, ranges, halveToLeaves);
    return ranges;
}

/// Eight roots next to each other, so that the first spheres are as small as can be; of a small shell what faces apart.
std::vector<PointRange> partRoots(std::vector<ClusterPoint>& items) {
    const PointRange all{0, static_cast<std::uint32_t>(items.size())};
    if (all.count() <= SphereTree::kChildren * SphereTree::kLeafPoints) return part(items, all);
    std::vector<PointRange> ranges{all};
    splitAll(items, ranges, halveToLeaves);
    return ranges;
}

Facing facingOf(const Vec3& normal, double area) { return {normal.cast<float>(), static_cast<float>(area)}; }

/// Sphere, areas and representative of a node.
void summarise(std::span<const SurfacePoint> below, SphereNode& node) {
    const Ball ball = enclosingBall(below);
    node.centre = roundedToFloat(ball.centre);
    node.radius = ball.radius + (1.0 + 1e-12) * (node.centre - ball.centre).norm();
    node.area = 0.0;
    Vec3 middle = Vec3::Zero(), mean = Vec3::Zero(), area_vector = Vec3::Zero();
    for (const SurfacePoint& point : below) {
        node.area += point.area;
        middle += point.area * point.position;
        mean += point.position;
        area_vector += point.area * point.normal;
    }
    middle = node.area > 0.0 ? Vec3(middle / node.area) : Vec3(mean / static_cast<double>(below.size()));
    const SurfacePoint* nearest = nullptr;
    for (const SurfacePoint& point : below) {
        if (node.area > 0.0 && !(point.area > 0.0)) continue;
        if (nearest == nullptr || (point.position - middle).squaredNorm() < (nearest->position - middle).squaredNorm())
            nearest = &point;
    }
    node.point = nearest->position;
    node.facing_area = area_vector.norm();
    node.normal = node.facing_area > 0.0 ? Vec3(area_vector / node.facing_area) : nearest->normal;
}

}  // namespace

SphereTree::SphereTree(const PointShell& shell, const geometry::TriangleMesh& mesh)
    : surface_(mesh), total_area_(shell.total_area), cover_radius_(shell.cover_radius), rounding_(shell.rounding) {
    std::vector<ClusterPoint> items;
    items.reserve(shell.points.size());
    double sum = 0.0, largest = 0.0;
    for (const SurfacePoint& point : shell.points) {
        sum += point.position.squaredNorm();
        largest = std::max(largest, point.position.squaredNorm());
        const Eigen::Vector3f p = point.position.cast<float>(), n = point.normal.cast<float>();
        items.push_back(
            {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, static_cast<std::uint32_t>(items.size()), point.area > 0.0});
    }
    gyration_radius_ = std::sqrt(sum / static_cast<double>(shell.points.size()));
    reach_ = std::sqrt(largest);

    std::vector<PointRange> ranges = partRoots(items);
    root_count_ = ranges.size();
    levels_ = 1;
    std::size_t level_end = root_count_;
    nodes_.resize(root_count_);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if (i == level_end) {
            ++levels_;
            level_end = ranges.size();
        }
        const PointRange range = ranges[i];
        const std::vector<PointRange> parts = part(items, range);
        SphereNode& node = nodes_[i];
        node.leaf = parts.size() == 1;
        node.first = node.leaf ? range.begin : static_cast<std::uint32_t>(ranges.size());
        node.count = node.leaf ? range.count() : static_cast<std::uint32_t>(parts.size());
        if (node.leaf) {
            arrangeGroups(items, range);
            continue;
        }
        ranges.insert(ranges.end(), parts.begin(), parts.end());
        nodes_.resize(ranges.size());
    }

    points_.reserve(items.size());
    for (const ClusterPoint& item : items) {
        points_.push_back(shell.points[item.index]);
        positions_.add(item.position[0], item.position[1], item.position[2]);
        facings_.push_back(facingOf(points_.back().normal, points_.back().area));
    }
    geometry::parallelFor((nodes_.size() + kNodesAtOnce - 1) / kNodesAtOnce, [&](std::size_t batch) {
        const std::size_t end = std::min(nodes_.size(), (batch + 1) * kNodesAtOnce);
        for (std::size_t i = batch * kNodesAtOnce; i < end; ++i)
            summarise(std::span<const SurfacePoint>(points_).subspan(ranges[i].begin, ranges[i].count()), nodes_[i]);
    });
    for (const SphereNode& node : nodes_) {
        const Eigen::Vector3f centre = node.centre.cast<float>();
        centres_.add(centre.x(), centre.y(), centre.z());
        radii_.push_back(roundedUpToFloat(node.radius));
    }
    formGroups();
}

void SphereTree::formGroups() {
    std::vector<SphereNode*> leaves;
    for (SphereNode& node : nodes_)
        if (node.leaf) leaves.push_back(&node);
    std::sort(leaves.begin(), leaves.end(),
              [](const SphereNode* a, const SphereNode* b) { return a->first < b->first; });
    for (SphereNode* leaf : leaves) {
        SphereNode& node = *leaf;
        node.first_group = static_cast<std::uint32_t>(group_points_.size());
        for (std::uint32_t begin = node.first; begin < node.first + node.count; begin += kGroupPoints) {
            const std::uint32_t count = std::min(kGroupPoints, node.first + node.count - begin);
            const auto points = std::span<const SurfacePoint>(points_).subspan(begin, count);
            double area = 0.0;
            Vec3 mean = Vec3::Zero(), weighted = Vec3::Zero(), area_vector = Vec3::Zero();
            for (const SurfacePoint& point : points) {
                area += point.area;
                mean += point.position / static_cast<double>(count);
                weighted += point.area * point.position;
                area_vector += point.area * point.normal;
            }
            const Vec3 middle = roundedToFloat(area > 0.0 ? Vec3(weighted / area) : mean);
            const double weight = area_vector.norm();
            double radius = 0.0;
            for (const SurfacePoint& point : points) radius = std::max(radius, (point.position - middle).norm());
            const Eigen::Vector3f p = middle.cast<float>();
            group_facings_.push_back(facingOf(weight > 0.0 ? Vec3(area_vector / weight) : points[0].normal, weight));
            group_positions_.add(p.x(), p.y(), p.z());
            group_radii_.push_back(roundedUpToFloat(radius));
            group_points_.push_back(begin);
        }
    }
    group_points_.push_back(static_cast<std::uint32_t>(points_.size()));
}

std::size_t SphereTree::memoryBytes() const {
    constexpr std::size_t kNode = sizeof(SphereNode) + 4 * sizeof(float);
    constexpr std::size_t kPoint = sizeof(SurfacePoint) + sizeof(Facing) + 3 * sizeof(float);
    constexpr std::size_t kGroup = sizeof(Facing) + 4 * sizeof(float) + sizeof(std::uint32_t);
    return nodes_.size() * kNode + points_.size() * kPoint + group_radii_.size() * kGroup + surface_.memoryBytes();
}

}  // namespace passung::shell
