#include "core/model/sphere_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/model/disk_subset.h"

namespace passung::model {

namespace {

constexpr double kLevelRatio = 2.8;  // of the disk radius from level to level: about eight children a node
constexpr std::size_t kMaxRoots = 8;
constexpr int kEnclosingSteps = 60;

/// One level under construction: every cluster with its members on the level below.
struct Level {
    std::vector<std::uint32_t> representative;        // index of a shell point
    std::vector<std::vector<std::uint32_t>> members;  // clusters (or points, at the finest level) of the level below
};

/// Near-minimal enclosing sphere by the core-set iteration of Badoiu and Clarkson (2003): the centre steps towards the
/// farthest point by 1/(i+1); the radius is then exact for that centre.
void enclose(std::span<const SurfacePoint> points, std::span<const std::uint32_t> below, SphereNode& node) {
    const auto farthest = [&](const Vec3& from) {
        std::uint32_t best = below[0];
        double distance = -1.0;
        for (const std::uint32_t i : below) {
            const double d = (points[i].position - from).squaredNorm();
            if (d > distance) {
                distance = d;
                best = i;
            }
        }
        return best;
    };
    Vec3 low = points[below[0]].position, high = low;
    for (const std::uint32_t i : below) {
        low = low.cwiseMin(points[i].position);
        high = high.cwiseMax(points[i].position);
    }
    node.centre = 0.5 * (low + high);
    double best = (points[farthest(node.centre)].position - node.centre).norm();
    Vec3 centre = node.centre;
    for (int i = 1; i <= kEnclosingSteps; ++i) {
        const Vec3 far = points[farthest(centre)].position;
        const double radius = (far - centre).norm();
        if (radius < best) {
            best = radius;
            node.centre = centre;
        }
        centre += (far - centre) / (i + 1);
    }
    node.radius = best * (1.0 + 1e-12);
}

/// Groups `items` (shell points, representatives of a level) into clusters of about eight.
Level clustered(std::span<const SurfacePoint> points, const std::vector<std::uint32_t>& items, double radius) {
    std::vector<Vec3> positions, normals;
    for (const std::uint32_t i : items) {
        positions.push_back(points[i].position);
        normals.push_back(points[i].normal);
    }
    std::vector<std::uint32_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto chosen = diskSubset(positions, normals, radius, order);
    std::vector<std::uint32_t> nearest = assignNearest(positions, normals, radius, chosen);
    // A point without a direction (a knife edge) faces nobody: its own choice of cluster is itself.
    for (std::uint32_t k = 0; k < chosen.size(); ++k) nearest[chosen[k]] = k;
    Level level;
    level.members.resize(chosen.size());
    for (const std::uint32_t k : chosen) level.representative.push_back(items[k]);
    for (std::uint32_t i = 0; i < items.size(); ++i) level.members[nearest[i]].push_back(i);
    return level;
}

/// Bottom up: level 0 groups the points, each next level groups the clusters of the one below.
std::vector<Level> groupUpwards(std::span<const SurfacePoint> points, double total_area) {
    Bounds bounds;
    for (const auto& point : points) bounds.extend(point.position);
    const double size = std::max(bounds.size().norm(), 1e-9);
    double radius = kLevelRatio * std::sqrt(std::max(total_area, 1e-12) / static_cast<double>(points.size()));
    std::vector<Level> levels;
    std::vector<std::uint32_t> items(points.size());
    std::iota(items.begin(), items.end(), 0u);
    do {
        levels.push_back(clustered(points, items, radius));
        items = levels.back().representative;
        radius *= kLevelRatio;
    } while (items.size() > kMaxRoots && radius < kLevelRatio * size);
    return levels;
}

/// Top down: nodes breadth first, the children of a node and the points of a leaf contiguous.
void layOutDownwards(std::span<const SurfacePoint> points, const std::vector<Level>& levels,
                     std::vector<SphereNode>& nodes, std::vector<SurfacePoint>& ordered) {
    std::vector<std::uint32_t> clusters(levels.back().members.size());  // of the level, in node order
    std::iota(clusters.begin(), clusters.end(), 0u);
    std::size_t first_node = 0;
    for (std::size_t l = levels.size(); l-- > 0;) {
        std::vector<std::uint32_t> next;
        nodes.resize(first_node + clusters.size());
        for (std::size_t k = 0; k < clusters.size(); ++k) {
            const auto& members = levels[l].members[clusters[k]];
            SphereNode& node = nodes[first_node + k];
            const SurfacePoint& representative = points[levels[l].representative[clusters[k]]];
            node.point = representative.position;
            node.normal = representative.normal;
            node.leaf = l == 0;
            node.count = static_cast<std::uint32_t>(members.size());
            if (node.leaf) {
                node.first = static_cast<std::uint32_t>(ordered.size());
                for (const std::uint32_t i : members) ordered.push_back(points[i]);
            } else {
                node.first = static_cast<std::uint32_t>(first_node + clusters.size() + next.size());
                next.insert(next.end(), members.begin(), members.end());
            }
        }
        first_node += clusters.size();
        clusters = std::move(next);
    }
}

/// Bottom up again: spheres and areas.
void encloseUpwards(std::span<const SurfacePoint> ordered, std::vector<SphereNode>& nodes) {
    std::vector<std::array<std::uint32_t, 2>> range(nodes.size());  // the points below, contiguous as children are
    std::vector<std::uint32_t> below;
    for (std::size_t i = nodes.size(); i-- > 0;) {
        SphereNode& node = nodes[i];
        range[i] = node.leaf ? std::array{node.first, node.first + node.count}
                             : std::array{range[node.first][0], range[node.first + node.count - 1][1]};
        below.resize(range[i][1] - range[i][0]);
        std::iota(below.begin(), below.end(), range[i][0]);
        enclose(ordered, below, node);
        node.area = 0.0;
        for (const std::uint32_t p : below) node.area += ordered[p].area;
    }
}

}  // namespace

SphereTree::SphereTree(const PointShell& shell) : total_area_(shell.total_area), cover_radius_(shell.cover_radius) {
    double sum = 0.0, largest = 0.0;
    for (const auto& point : shell.points) {
        sum += point.position.squaredNorm();
        largest = std::max(largest, point.position.squaredNorm());
    }
    gyration_radius_ = std::sqrt(sum / static_cast<double>(shell.points.size()));
    reach_ = std::sqrt(largest);

    const std::vector<Level> levels = groupUpwards(shell.points, total_area_);
    levels_ = static_cast<int>(levels.size());
    root_count_ = levels.back().members.size();
    layOutDownwards(shell.points, levels, nodes_, points_);
    encloseUpwards(points_, nodes_);
}

}  // namespace passung::model
