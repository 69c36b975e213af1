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
Level cluster(std::span<const SurfacePoint> points, const std::vector<std::uint32_t>& items, double radius) {
    std::vector<Vec3> positions, normals;
    for (const std::uint32_t i : items) {
        positions.push_back(points[i].position);
        normals.push_back(points[i].normal);
    }
    std::vector<std::uint32_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto chosen = diskSubset(positions, normals, radius, order);
    std::vector<std::uint32_t> nearest;
    assignNearest(positions, normals, radius, chosen, nearest);
    // A point without a direction (a knife edge) faces nobody: its own choice of cluster is itself.
    for (std::uint32_t k = 0; k < chosen.size(); ++k) nearest[chosen[k]] = k;
    Level level;
    level.members.resize(chosen.size());
    for (const std::uint32_t k : chosen) level.representative.push_back(items[k]);
    for (std::uint32_t i = 0; i < items.size(); ++i) level.members[nearest[i]].push_back(i);
    return level;
}

}  // namespace

SphereTree::SphereTree(const PointShell& shell) : total_area_(shell.total_area), cover_radius_(shell.cover_radius) {
    const auto& points = shell.points;
    double sum = 0.0, largest = 0.0;
    Bounds bounds;
    for (const auto& point : points) {
        sum += point.position.squaredNorm();
        largest = std::max(largest, point.position.squaredNorm());
        bounds.extend(point.position);
    }
    gyration_radius_ = std::sqrt(sum / static_cast<double>(points.size()));
    reach_ = std::sqrt(largest);

    // Bottom up: level 0 groups the points, each next level groups the clusters of the one below.
    std::vector<Level> levels;
    std::vector<std::uint32_t> items(points.size());
    std::iota(items.begin(), items.end(), 0u);
    double radius = kLevelRatio * std::sqrt(std::max(total_area_, 1e-12) / static_cast<double>(points.size()));
    const double size = std::max(bounds.size().norm(), 1e-9);
    do {
        levels.push_back(cluster(points, items, radius));
        items = levels.back().representative;
        radius *= kLevelRatio;
    } while (items.size() > kMaxRoots && radius < kLevelRatio * size);
    levels_ = static_cast<int>(levels.size());

    // Top down: breadth first, children contiguous. `clusters` are the level's clusters in node order.
    root_count_ = levels.back().members.size();
    std::vector<std::uint32_t> clusters(root_count_);
    std::iota(clusters.begin(), clusters.end(), 0u);
    std::size_t first_node = 0;
    for (std::size_t l = levels.size(); l-- > 0;) {
        std::vector<std::uint32_t> next;
        nodes_.resize(first_node + clusters.size());
        for (std::size_t k = 0; k < clusters.size(); ++k) {
            const auto& members = levels[l].members[clusters[k]];
            SphereNode& node = nodes_[first_node + k];
            const SurfacePoint& representative = points[levels[l].representative[clusters[k]]];
            node.point = representative.position;
            node.normal = representative.normal;
            node.leaf = l == 0;
            node.count = static_cast<std::uint32_t>(members.size());
            if (node.leaf) {
                node.first = static_cast<std::uint32_t>(points_.size());
                for (const std::uint32_t i : members) points_.push_back(points[i]);
            } else {
                node.first = static_cast<std::uint32_t>(first_node + clusters.size() + next.size());
                next.insert(next.end(), members.begin(), members.end());
            }
        }
        first_node += clusters.size();
        clusters = std::move(next);
    }

    // Bottom up again: the points below every node are a contiguous range, because children are.
    std::vector<std::array<std::uint32_t, 2>> range(nodes_.size());
    std::vector<std::uint32_t> below;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        SphereNode& node = nodes_[i];
        range[i] = node.leaf ? std::array{node.first, node.first + node.count}
                             : std::array{range[node.first][0], range[node.first + node.count - 1][1]};
        below.resize(range[i][1] - range[i][0]);
        std::iota(below.begin(), below.end(), range[i][0]);
        enclose(points_, below, node);
        node.area = 0.0;
        for (const std::uint32_t p : below) node.area += points_[p].area;
    }
}

}  // namespace passung::model
