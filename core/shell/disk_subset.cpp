#include "core/shell/disk_subset.h"

namespace passung::shell {

namespace {

geometry::Bounds boundsOf(std::span<const Vec3> positions) {
    geometry::Bounds bounds;
    for (const Vec3& p : positions) bounds.extend(p);
    return bounds;
}

}  // namespace

PointBuckets::PointBuckets(std::span<const Vec3> positions, double edge) : PointBuckets(boundsOf(positions), edge) {}

PointBuckets::PointBuckets(const geometry::Bounds& bounds, double edge) {
    const bool empty = !(bounds.high.x() >= bounds.low.x());
    low_ = empty ? Vec3(Vec3::Zero()) : bounds.low;
    const Vec3 size = empty ? Vec3(Vec3::Zero()) : bounds.size();
    const auto blocksAlong = [&](int axis) { return std::floor(size[axis] / (edge * (1 << kShift))) + 1.0; };
    while (blocksAlong(0) * blocksAlong(1) * blocksAlong(2) > kMostBlocks) edge *= 1.25;
    edge_ = edge;
    inverse_edge_ = 1.0 / edge;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count_[axis] = static_cast<int>(size[static_cast<int>(axis)] * inverse_edge_) + 1;
        blocks_[axis] = static_cast<std::size_t>(count_[axis] + kMask) >> kShift;
    }
    block_.assign(blocks_[0] * blocks_[1] * blocks_[2], -1);
}

std::array<int, 3> PointBuckets::cellOf(const Vec3& p) const {
    std::array<int, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        cell[axis] = std::clamp(static_cast<int>((p[i] - low_[i]) * inverse_edge_), 0, count_[axis] - 1);
    }
    return cell;
}

void PointBuckets::insert(const Vec3& p, std::uint32_t index) {
    if (index >= next_.size()) next_.resize(std::max<std::size_t>(index + 1, next_.size() + next_.size() / 2), -1);
    const std::array<int, 3> c = cellOf(p);
    std::int32_t& block = block_[blockOf(c)];
    if (block < 0) {
        block = static_cast<std::int32_t>(first_.size() / kBlockCells);
        first_.resize(first_.size() + kBlockCells, -1);
    }
    std::int32_t& head = first_[static_cast<std::size_t>(block) * kBlockCells + inBlock(c)];
    next_[index] = head;
    head = static_cast<std::int32_t>(index);
}

std::vector<std::uint32_t> diskSubset(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                      std::span<const std::uint32_t> order) {
    const auto position = [&](std::uint32_t i) -> const Vec3& { return positions[i]; };
    const auto normal = [&](std::uint32_t i) -> const Vec3& { return normals[i]; };
    return diskSubset(boundsOf(positions), position, normal, radius, order);
}

NearestAlike::NearestAlike(const geometry::Bounds& bounds, std::span<const Vec3> positions,
                           std::span<const Vec3> normals, double edge)
    : positions_(positions), normals_(normals), buckets_(bounds, edge) {
    for (std::uint32_t k = 0; k < positions.size(); ++k) buckets_.insert(positions[k], k);
}

std::uint32_t NearestAlike::at(const Vec3& p, const Vec3& normal, double radius, std::uint32_t hint) const {
    std::uint32_t nearest = kNoPoint;
    if (hint != kNoPoint && facesAlike(normal, normals_[hint])) {
        const double distance = (p - positions_[hint]).norm();
        if (distance < radius) {
            radius = distance * (1.0 + 1e-9);
            nearest = hint;
        }
    }
    if (nearest == kNoPoint && radius > buckets_.edge()) {  // the nearest is seldom farther than a bucket
        const std::uint32_t near = at(p, normal, buckets_.edge());
        if (near != kNoPoint) return near;
    }
    buckets_.visitWithin(p, radius, [&](std::uint32_t k, double squared) {
        const double d = (p - positions_[k]).squaredNorm();
        if (d > squared || (d == squared && !(k < nearest && nearest != kNoPoint))) return squared;
        if (!facesAlike(normal, normals_[k])) return squared;
        nearest = k;
        return d;
    });
    return nearest;
}

std::vector<std::uint32_t> assignNearest(std::span<const Vec3> positions, std::span<const Vec3> normals, double radius,
                                         std::span<const std::uint32_t> chosen) {
    std::vector<Vec3> at, facing;
    for (const std::uint32_t i : chosen) {
        at.push_back(positions[i]);
        facing.push_back(normals[i]);
    }
    const NearestAlike found(boundsOf(positions), at, facing, radius);
    std::vector<std::uint32_t> nearest(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) nearest[i] = found.at(positions[i], normals[i], radius);
    return nearest;
}

}  // namespace passung::shell
